// What a test's p has to reach, and figures of a vote as people read them, the same on a terminal
// and in a report.
#pragma once

#include <cstdint>
#include <string>

#include "evaluation/statistics/preference_tests.h"

namespace livery {

/// Of every test whose result is put into a verdict.
inline constexpr double kSignificanceLevel = 0.05;

/// "p = 0.012"; the smallest are "p < 0.0001".
std::string p_words(double p);

/// "2.37", "0.034", "over 9999"
std::string odds_text(double odds);
/// "exact", "1000000 draws"
std::string method_text(Method method, std::int64_t cases);
/// "0.0059", "0.15", "under 0.0001"
std::string p_text(double p);
/// "7.2%", "93%", "under 0.1%"; "0%" and "100%" are just that
std::string percent_text(double share);

/// Measured in drawn rounds (docs/evaluation.md).
inline constexpr const char* kGhostIntervals =
    " If the designs are liked alike, that one has no vote is chance, and the 95% intervals hold "
    "in "
    "about 60% of such rounds.";

}  // namespace livery
