// Tails of the distributions that large samples tend to, intervals of shares, what a test's p has
// to reach, and figures as people read them, the same on a terminal and in a report.
#pragma once

#include <cstdint>
#include <string>

#include "evaluation/statistics/preference_tests.h"

namespace livery {

/// The 97.5% point of the standard normal, and the 95% point of chi-square with one degree.
inline constexpr double kNormal975 = 1.959963984540054;
inline constexpr double kChiSquare95 = kNormal975 * kNormal975;

/// P(X >= x) of chi-square with `degrees` >= 1.
double chi_square_tail(double x, int degrees);

/// P(X >= at_least) of a binomial of `of` trials, each of this probability in 0 to 1; exact but for
/// rounding. 1 where nothing is asked for.
double binomial_tail(int at_least, int of, double probability);

/// The 97.5% point of Student's t with `degrees` >= 1.
double student_975(int degrees);

struct Interval {
    double low = 0.0, high = 1.0;
};

/// 95% interval of a share of `count` among `of` (Wilson 1927). Of none it is all of 0 to 1.
Interval wilson_interval(int count, int of);

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
