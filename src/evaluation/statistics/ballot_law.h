// Which ballots come about with what probability.
#pragma once

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

}  // namespace livery
