// What answers on semantic scales say of each look, and whether looks differ on a scale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/statistics/figures.h"
#include "evaluation/typed_words.h"

namespace livery {

struct LookOnScale {
    int answers = 0;
    double mean = 0.0;  ///< of the steps; none without answers
    /// 95%, percentiles of means over evaluators drawn again (Efron 1979), those that make up for
    /// few evaluators as Student's t does (the expanded ones of Hesterberg 2015). Of less than
    /// eight evaluators it is all of 1 to 7.
    Interval interval{1.0, 7.0};
};

struct ScaleFigures {
    SemanticScale scale;
    std::vector<LookOnScale> looks;  ///< by design
    int complete = 0;                ///< evaluators who placed every look on it: those of the test
    double friedman_q = 0.0;         ///< with ties (Friedman 1937)
    /// Of each evaluator's steps being as likely in any order over the looks; drawn, and counted
    /// with what was found, so that it is never too small.
    double friedman_p = 1.0;
    double holm_p = 1.0;  ///< over all scales of the round (Holm 1979)
    std::string words;
};

struct ScaleStatistics {
    std::vector<ScaleFigures> scales;
    int evaluators = 0;  ///< with any answer
    std::size_t draws = 0;
    std::uint64_t seed = 1;
};

inline constexpr std::size_t kScaleDraws = 9999;

/// `names` are the designs'. The draws go by the seed alone. Throws std::invalid_argument for
/// answers of another number of designs or scales, or steps outside 0 to 7.
ScaleStatistics scale_statistics(const std::vector<ScaleAnswers>& answers,
                                 const std::vector<SemanticScale>& scales,
                                 const std::vector<std::string>& names,
                                 std::uint64_t seed,
                                 std::size_t draws = kScaleDraws);

/// Adjusted so that, of true hypotheses, none is rejected at 5% in 95% of families.
std::vector<double> holm_adjusted(const std::vector<double>& p);

}  // namespace livery
