// What a fresh round would tell, and what this one can be believed to.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "evaluation/statistics/plackett_luce.h"

namespace livery {

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
