// Which ballots come about with what probability, and draws of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/random.h"
#include "evaluation/ballot.h"

namespace livery {

/// Every ballot that can be, with its probability.
struct BallotLaw {
    int designs = 0;
    bool has_least = false;
    std::vector<Ballot> ballots;
    std::vector<double> probabilities;  ///< they add up to 1
    std::vector<double> cumulative;     ///< up to and with each
    std::vector<std::size_t> guide;     ///< where in `cumulative` each 256th of the sum begins
};

/// Plackett and Luce's: best in proportion to worth, second best among the others likewise; least
/// among those left in proportion to 1 / worth. Equal worths make all ballots equally likely.
BallotLaw ballot_law(const std::vector<double>& worths, bool has_least);

/// The number of a ballot.
std::size_t draw_ballot(const BallotLaw& law, Random& random);
std::vector<Ballot> draw_round(const BallotLaw& law, int evaluators, Random& random);

/// What `evaluators` ballots have in the mean.
struct ExpectedVotes {
    std::vector<double> best, second, least;
    std::vector<double> pairs;  ///< [best * designs + second]
};
ExpectedVotes expected_votes(const BallotLaw& law, double evaluators);

/// Calls draw(random, index) for each index below `count`, over all threads. Each has its
/// generator, that goes by seed, `purpose` and index alone.
void for_draws(std::size_t count,
               std::uint64_t seed,
               std::uint32_t purpose,
               const std::function<void(Random& random, std::size_t index)>& draw);

/// Draws `draws` rounds of `evaluators`, each of whom makes one of `choices` (what it adds to each
/// of up to 26 sums, at most 60 each): told(index, sums) for every draw, from any thread. The same
/// for a seed and `purpose` on any number of threads.
void draw_sums(const std::vector<std::vector<int>>& choices,
               int evaluators,
               std::size_t draws,
               std::uint64_t seed,
               std::uint32_t purpose,
               const std::function<void(std::size_t index, const std::vector<int>& sums)>& told);

}  // namespace livery
