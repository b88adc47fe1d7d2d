// A duel of the two looks that lead a round: blind repeats, a fresh test with data of its own.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballot.h"
#include "evaluation/ballots.h"
#include "evaluation/statistics/duel_statistics.h"

namespace livery {

inline constexpr int kDuelRepeats = 3;

/// The two designs with the largest worths (Plackett and Luce's), as `top_two` of the tally, the
/// larger first. Throws Refused, with what to do, when nobody has voted and when the second and
/// third largest worths are the same.
std::array<int, 2> leading_two(const VoteCounts& counts,
                               const std::vector<std::string>& names,
                               const std::vector<Ballot>* ballots = nullptr);

/// The next repeat of the duel of a locked round's leaders: the first one, or that of a series
/// that is under way, which `round` may be one of. The seed goes with it: repeat 2 has `seed` + 1.
/// Throws as leading_two() and the store do, and Refused for a round of a series that is over.
RoundSetup next_repeat(const BallotStore& store, int round, int seed);

struct DuelRecord {
    Series series;
    std::vector<DuelAnswers> answers;  ///< of each seat that has any, in an order that says nothing
    std::vector<std::array<int, 2>> votes;  ///< how often each look was chosen in each repeat held
    DuelStatistics statistics;
    std::string words;
};
/// Nothing for a round that is no repeat. Refused while the series is under way.
std::optional<DuelRecord> duel_of(const BallotStore& store, int round);

}  // namespace livery
