#include "evaluation/statistics/figure_words.h"

#include <fmt/format.h>

namespace livery {

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
