// Inputs at which reflectance models break, and what a model does at them: the measurements behind
// the stability ledger and its tests.
#pragma once

#include <cstddef>
#include <vector>

#include "appearance/bsdf.h"
#include "core/random.h"

namespace livery {

/// The cosine exponent that stands for a slope parameter: alpha^2 = 2 / (n + 2).
double exponent_of(double alpha);

/// Slope parameters of the ledger, each model's own: models of exponents end at exponent 1e6.
std::vector<double> ledger_alphas(ReflectanceModel model);

/// Saturated colours, `alpha` the smaller slope parameter (exponents alike) and `stretch` times it
/// across, at most 1. Every number is one that float holds.
f64::BsdfParameters ledger_parameters(double alpha, double stretch);

/// Directions that float holds, so that both precisions are fed the same.
struct RoundedPair {
    glm::vec3 wi, wo;
};
/// Above the horizon down to 89.99 degrees, half of them close to grazing; most wi near the mirror
/// direction of their wo, within a few alpha.
std::vector<RoundedPair> ledger_directions(double alpha, std::size_t count, Random& random);

/// Parameters at and between the ends of their ranges.
f32::BsdfParameters extreme_parameters(Random& random);
/// Random, grazing, denormal, below the horizon, opposite, equal and mirrored directions.
RoundedPair extreme_directions(Random& random);

struct InvalidValues {
    std::size_t inputs = 0;
    std::size_t invalid = 0;  ///< NaN, infinite, negative, or light through the surface
};
/// Evaluates value and density, in float, at extreme inputs.
InvalidValues count_invalid(ReflectanceModel model, std::size_t inputs, std::uint64_t seed);

/// How far values lie from those in double at the same inputs, relative, wherever double exceeds
/// 1e-6.
inline constexpr double kLeastComparedValue = 1e-6;
/// Infinite where a value is no number, however dark.
double relative_error(double value, double truth);
struct PrecisionError {
    double alpha = 0.0;
    double allowed = 0.0;  ///< max(1e-4, 4e-7 / alpha)
    double float_worst = 0.0;
    double float_density_worst = 0.0;
};
/// A row for each of ledger_alphas(): the worst over anisotropies of 1, 10 and 100.
std::vector<PrecisionError> precision_errors(ReflectanceModel model,
                                             std::size_t pairs_each,
                                             std::uint64_t seed);

/// The largest relative difference of values in float with light and eye exchanged, over the
/// ledger's slope parameters.
double reciprocity_error(ReflectanceModel model, std::size_t pairs_each, std::uint64_t seed);

/// The anisotropies of the ledger that the model takes.
std::vector<double> ledger_stretches(ReflectanceModel model);

struct WorstAlbedo {
    double albedo = 0.0;  ///< largest of the three channels
    double alpha = 0.0, mu = 0.0;
    double reflectance = 0.0;  ///< f0 or `specular`
};
/// Of a white surface, `diffuse` and `specular` adding up to 1, over slope parameters, f0 and
/// angles, by quadrature of `points` a side.
WorstAlbedo worst_albedo(ReflectanceModel model, int points);

}  // namespace livery
