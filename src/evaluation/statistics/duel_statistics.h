// What a duel says: two looks, judged blind several times by the same evaluators.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "evaluation/statistics/figures.h"

namespace livery {

/// What one evaluator answered in each repeat: 0 or 1, which of the two looks; -1: nothing.
using DuelAnswers = std::vector<int>;

enum class DuelVerdictKind {
    nobody,         ///< no answers
    too_few,        ///< even if all agreed the sign test would not pass
    no_preference,  ///< its p is above .05
    preferred
};
const char* to_string(DuelVerdictKind kind);  ///< "no preference", ...

/// Each evaluator counts once, by the majority of the repeats: answers of one person are no
/// independent ones. Who has too few answers for one counts for neither.
struct DuelStatistics {
    int repeats = 3;
    int evaluators = 0;               ///< with at least one answer
    std::array<int, 2> majorities{};  ///< how many chose each in more than half of all repeats
    int incomplete = 0;               ///< evaluators without an answer in some repeat
    int incomplete_counted = 0;       ///< of those, with a majority that the rest could not change
    double sign_p = 1.0;              ///< exact, two-sided
    int ahead = 0;                    ///< which has more majorities; 0 where they have as many
    Interval share;                   ///< of `ahead` among majorities, 95% (Wilson)

    int complete = 0;    ///< evaluators with an answer in every repeat
    int consistent = 0;  ///< of those, with the same in all
    /// Of guessing: as many or more consistent ones, exact; guessing gives 2^(1 - repeats) of them.
    double consistency_p = 1.0;
    double consistent_by_guessing = 0.25;
    Interval consistent_share;  ///< 95% (Wilson)

    DuelVerdictKind kind = DuelVerdictKind::nobody;
};

/// Throws std::invalid_argument for less than two repeats, another number of answers, or others
/// than -1, 0 and 1.
DuelStatistics duel_statistics(const std::vector<DuelAnswers>& answers, int repeats);

/// The verdict and what is to be known with it, in sentences that never say more than the answers.
/// `shown`: repeats that were held; fewer than planned where the series was broken off.
std::string words_of(const DuelStatistics& statistics,
                     const std::array<std::string, 2>& names,
                     int shown);

}  // namespace livery
