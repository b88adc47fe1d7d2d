#include "evaluation/statistics/figures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <unsupported/Eigen/SpecialFunctions>

namespace livery {

double chi_square_tail(double x, int degrees) {
    if (!(x > 0.0)) return 1.0;
    return std::clamp(Eigen::numext::igammac(0.5 * degrees, 0.5 * x), 0.0, 1.0);
}

double binomial_tail(int at_least, int of, double probability) {
    if (at_least <= 0) return 1.0;
    if (at_least > of || probability <= 0.0) return 0.0;
    if (probability >= 1.0) return 1.0;
    double tail = 0.0;
    for (int k = of; k >= at_least; --k) {
        tail += std::exp(std::lgamma(of + 1.0) - std::lgamma(k + 1.0) - std::lgamma(of - k + 1.0) +
                         k * std::log(probability) + (of - k) * std::log1p(-probability));
    }
    return std::min(1.0, tail);
}

double student_975(int degrees) {
    const double half = 0.5 * degrees;
    // The tail is I(degrees / (degrees + t^2); degrees / 2, 1 / 2) / 2 and falls with t.
    double low = 0.0, high = 20.0;
    for (int step = 0; step < 80; ++step) {
        const double t = 0.5 * (low + high);
        const double tail = 0.5 * Eigen::numext::betainc(half, 0.5, degrees / (degrees + t * t));
        (tail > 0.025 ? low : high) = t;
    }
    return 0.5 * (low + high);
}

Interval wilson_interval(int count, int of) {
    if (of <= 0) return {};
    const double n = of, share = count / n, z2 = kChiSquare95;
    const double centre = (share + z2 / (2.0 * n)) / (1.0 + z2 / n);
    const double half =
        kNormal975 / (1.0 + z2 / n) * std::sqrt(share * (1.0 - share) / n + z2 / (4.0 * n * n));
    return {count == 0 ? 0.0 : std::max(0.0, centre - half),
            count == of ? 1.0 : std::min(1.0, centre + half)};
}

std::string p_words(double p) {
    return p < 0.0001 ? std::string("p < 0.0001") : fmt::format("p = {:.2g}", p);
}

std::string odds_text(double odds) {
    if (odds > 9999.0) return "over 9999";
    if (odds < 0.001) return "under 0.001";
    return fmt::format("{:.{}f}", odds, odds < 0.1 ? 3 : 2);
}

std::string method_text(Method method, std::int64_t cases) {
    return method == Method::exact ? "exact" : fmt::format("{} draws", cases);
}

std::string p_text(double p) {
    if (p < 0.0001) return "under 0.0001";
    return fmt::format("{:.{}f}", p, p < 0.01 ? 4 : 3);
}

std::string percent_text(double share) {
    const double percent = 100.0 * share;
    if (percent <= 0.0) return "0%";
    if (percent >= 100.0) return "100%";
    if (percent < 0.1) return "under 0.1%";
    if (percent > 99.9) return "over 99.9%";
    return fmt::format("{:.{}f}%", percent, percent < 10.0 || percent >= 99.5 ? 1 : 0);
}

}  // namespace livery
