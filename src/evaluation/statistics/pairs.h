// Two designs against each other, under the model of all.
#pragma once

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

}  // namespace livery
