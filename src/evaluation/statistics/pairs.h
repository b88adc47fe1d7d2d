// Two designs against each other: how far apart these ballots put them, what a fresh round would
// tell, and what this one can be believed to.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/statistics/plackett_luce.h"

namespace livery {

struct PairComparison {
    int a = 0, b = 0;
    double odds = 1.0;             ///< w_a / w_b: for one who prefers b, so many prefer a
    double low = 0.0, high = 0.0;  ///< 95% profile-likelihood interval
    double p = 1.0;                ///< likelihood ratio against equal worths, asymptotic
    double wald_low = 0.0, wald_high = 0.0, wald_p = 1.0;
};

PairComparison compare_pair(const LuceData& data, const LuceFit& fit, int a, int b);
/// Every pair once, a before b.
std::vector<PairComparison> compare_pairs(const LuceData& data, const LuceFit& fit);

/// The share of `rounds` fresh rounds of `evaluators`, drawn under `law`, in which the likelihood
/// ratio tells a from b at 5%.
double simulated_power(const BallotLaw& law,
                       int evaluators,
                       int a,
                       int b,
                       std::uint64_t seed,
                       std::size_t rounds = 4000);

/// How many evaluators a fresh round needs for a power of .80: from the deviance that a round of
/// the mean votes has, as the noncentrality of chi-square with one degree. Nothing where the worths
/// are the same, or it would be more than a million.
std::optional<int> evaluators_for_power(const BallotLaw& law, int a, int b);

/// p of the likelihood ratio of a against b by its own law at equal worths of the two, the others'
/// as these ballots have them, instead of by chi-square: with ten evaluators that is too small.
/// From up to `rounds` drawn rounds; stops, with what it has, once it cannot be .05 any more.
double calibrated_pair_p(const LuceData& data,
                         const LuceFit& fit,
                         bool has_least,
                         int evaluators,
                         int a,
                         int b,
                         std::uint64_t seed,
                         std::size_t rounds = 2000);

}  // namespace livery
