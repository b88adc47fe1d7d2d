#include "evaluation/statistics/pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "core/parallel.h"
#include "evaluation/statistics/figures.h"

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

namespace {

double drawn_deviance(const BallotLaw& law, int evaluators, int a, int b, Random& random) {
    const std::vector<Ballot> round = draw_round(law, evaluators, random);
    const VoteCounts counts = count_ballots(round, law.designs, law.has_least);
    const LuceData data = luce_data(counts, &round);
    return deviance(data, fit_luce(data), {a, b, 0.0});
}

}  // namespace

double simulated_power(
    const BallotLaw& law, int evaluators, int a, int b, std::uint64_t seed, std::size_t rounds) {
    std::vector<char> told(rounds, 0);
    for_draws(rounds, seed, 5, [&](Random& random, std::size_t index) {
        told[index] = drawn_deviance(law, evaluators, a, b, random) > kChiSquare95 ? 1 : 0;
    });
    return std::accumulate(told.begin(), told.end(), 0) / static_cast<double>(rounds);
}

std::optional<int> evaluators_for_power(const BallotLaw& law, int a, int b) {
    // (1.960 + 0.842)^2: the noncentrality at which chi-square's 95% point is passed in 80%.
    constexpr double needed = 7.8489;
    constexpr double unit = 100.0, most = 1e6;
    const LuceData data = luce_data(expected_votes(law, unit));
    const double each = deviance(data, fit_luce(data), {a, b, 0.0}) / unit;
    if (!(each * most > needed)) return std::nullopt;
    return static_cast<int>(std::ceil(needed / each));
}

double calibrated_pair_p(const LuceData& data,
                         const LuceFit& fit,
                         bool has_least,
                         int evaluators,
                         int a,
                         int b,
                         std::uint64_t seed,
                         std::size_t rounds) {
    const double found = deviance(data, fit, {a, b, 0.0});
    const LuceFit equal = fit_luce(data, HeldOdds{a, b, 0.0}, fit.log_worths);
    const BallotLaw law = ballot_law(worths_of(equal), has_least);
    // What differs by rounding alone is as large.
    const double as_large = found - 1e-7 * (1.0 + found);
    std::size_t drawn = 0;
    double larger = 0.0;
    constexpr std::size_t batch = 100;
    for (std::size_t first = 0; first < rounds; first += batch) {
        std::vector<char> hits(std::min(batch, rounds - first), 0);
        for_draws(hits.size(), seed + first, 6, [&](Random& random, std::size_t index) {
            const double deviance = drawn_deviance(law, evaluators, a, b, random);
            hits[index] = deviance >= as_large ? 1 : 0;
        });
        larger += std::accumulate(hits.begin(), hits.end(), 0);
        drawn += hits.size();
        if (larger > 0.05 * static_cast<double>(rounds)) break;
    }
    return (larger + 1.0) / (static_cast<double>(drawn) + 1.0);
}

}  // namespace livery
