#include "evaluation/statistics/pairs.h"

#include <cmath>
#include <cstddef>

#include "core/parallel.h"
#include "evaluation/statistics/tails.h"

namespace livery {

namespace {

/// The log-odds, on one side of the fitted ones, at which the deviance is that of the 95% point.
double profile_bound(
    const LuceData& data, const LuceFit& fit, int a, int b, double fitted, double step) {
    const auto excess = [&](double log_odds) {
        return deviance(data, fit, {a, b, log_odds}) - kChiSquare95;
    };
    // The deviance only grows, and without bound: a bracket, then false position. An end that is
    // kept twice counts half (the Illinois algorithm, Dowell and Jarratt 1971).
    int moved = 0;
    double inside = fitted, outside = fitted + step;
    double inner = -kChiSquare95, outer = excess(outside);
    while (outer < 0.0) {
        inside = outside;
        inner = outer;
        step *= 2.0;
        outside += step;
        outer = excess(outside);
    }
    for (int round = 0; round < 100 && std::abs(outside - inside) > 1e-9; ++round) {
        const double middle = inside + (outside - inside) * (-inner / (outer - inner));
        const double value = excess(middle);
        if (std::abs(value) < 1e-9) return middle;
        if (value < 0.0) {
            inside = middle;
            inner = value;
            if (moved == -1) outer *= 0.5;
            moved = -1;
        } else {
            outside = middle;
            outer = value;
            if (moved == 1) inner *= 0.5;
            moved = 1;
        }
    }
    return 0.5 * (inside + outside);
}

}  // namespace

PairComparison compare_pair(const LuceData& data, const LuceFit& fit, int a, int b) {
    PairComparison pair;
    pair.a = a;
    pair.b = b;
    const double log_odds =
        fit.log_worths[static_cast<std::size_t>(a)] - fit.log_worths[static_cast<std::size_t>(b)];
    const double error = standard_error(data, fit, a, b);
    const double reach = kNormal975 * error;
    pair.odds = std::exp(log_odds);
    pair.low = std::exp(profile_bound(data, fit, a, b, log_odds, -reach));
    pair.high = std::exp(profile_bound(data, fit, a, b, log_odds, reach));
    pair.p = chi_square_tail(deviance(data, fit, {a, b, 0.0}), 1);
    pair.wald_low = std::exp(log_odds - reach);
    pair.wald_high = std::exp(log_odds + reach);
    pair.wald_p = chi_square_tail(std::pow(log_odds / error, 2), 1);
    return pair;
}

std::vector<PairComparison> compare_pairs(const LuceData& data, const LuceFit& fit) {
    std::vector<PairComparison> pairs;
    const auto designs = static_cast<int>(fit.log_worths.size());
    for (int a = 0; a < designs; ++a) {
        for (int b = a + 1; b < designs; ++b) pairs.push_back({a, b});
    }
    parallel_for(pairs.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            pairs[k] = compare_pair(data, fit, pairs[k].a, pairs[k].b);
        }
    });
    return pairs;
}

}  // namespace livery
