#include "evaluation/statistics/power.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evaluation/statistics/tails.h"

namespace livery {

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
