// What a test's p has to reach, and its words.
#pragma once

#include <string>

namespace livery {

/// Of every test whose result is put into a verdict.
inline constexpr double kSignificanceLevel = 0.05;

/// "p = 0.012"; the smallest are "p < 0.0001".
std::string p_words(double p);

}  // namespace livery
