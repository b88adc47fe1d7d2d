// Tails of the distributions that large samples tend to, and intervals of shares.
#pragma once

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

}  // namespace livery
