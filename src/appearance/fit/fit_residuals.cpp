#include "appearance/fit/fit_residuals.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "core/colour.h"

namespace livery {
namespace {

constexpr double kFloor = 0.01;  // of f cos: darker is not seen beside a highlight

/// Of CIEDE2000: below it a difference counts by its square, since its length has no slope at 0.
constexpr double kSoft = 0.5;
/// Of the mean square of CIEDE2000 beside its mean: at 10 both count alike.
constexpr double kSquares = 0.1;
/// Of the mean square of the logarithms: at a third it counts as much as itself not squared.
constexpr double kLogarithms = 3.0;

double measure(Metric metric, double value, double cosine) {
    const double seen = std::max(value, 0.0) * cosine;
    return metric == Metric::logarithm ? std::log(seen + kFloor) : std::cbrt(seen);
}

std::size_t count_of(std::size_t all, std::size_t stride) { return (all + stride - 1) / stride; }

}  // namespace

Residuals sample_residuals(const FitSamples& samples, Metric metric, std::size_t stride) {
    std::vector<double> wanted;
    for (std::size_t i = 0; i < samples.pairs.size(); i += stride) {
        for (int c = 0; c < 3; ++c) {
            wanted.push_back(measure(metric, samples.values_working[i][c], samples.pairs[i].wi.z));
        }
    }
    const std::size_t count = wanted.size();
    return {count,
            [&samples, metric, stride, wanted = std::move(wanted)](
                const BoundBsdf<double, glm::dvec3>& paint, double* values) {
                std::size_t at = 0;
                for (std::size_t i = 0; i < samples.pairs.size(); i += stride) {
                    const DirectionPair& pair = samples.pairs[i];
                    const glm::dvec3 value = paint.eval(pair.wi, pair.wo);
                    for (int c = 0; c < 3; ++c, ++at) {
                        values[at] = measure(metric, value[c], pair.wi.z) - wanted[at];
                    }
                }
            }};
}

Residuals sphere_residuals(const DifferenceTruth& truth,
                           const FitSamples& samples,
                           SphereStrides strides) {
    const Residuals logarithms = sample_residuals(samples, Metric::logarithm, strides.samples);
    const std::size_t pixels = count_of(truth.sphere_pairs.size(), strides.pixels);
    return {
        3 * pixels + logarithms.count,
        [&truth, logarithms, strides, pixels](const BoundBsdf<double, glm::dvec3>& paint,
                                              double* values) {
            const double pixel_weight = 1.0 / static_cast<double>(pixels);
            for (std::size_t i = 0; i < truth.sphere_pairs.size(); i += strides.pixels) {
                const DirectionPair& pair = truth.sphere_pairs[i];
                const glm::dvec3 off = ciede2000_vector(
                    lab_on_sphere(paint.eval(pair.wi, pair.wo), pair.wi.z), truth.sphere_labs[i]);
                // |off|^2 (1 / sqrt(|off|^2 + soft^2) + squares)
                const double squared = glm::dot(off, off);
                const double weight =
                    std::sqrt(pixel_weight * (1.0 / std::sqrt(squared + kSoft * kSoft) + kSquares));
                for (int c = 0; c < 3; ++c) *values++ = weight * off[c];
            }
            logarithms.write(paint, values);
            const double weight = std::sqrt(kLogarithms / static_cast<double>(logarithms.count));
            for (std::size_t i = 0; i < logarithms.count; ++i) values[i] *= weight;
        }};
}

}  // namespace livery
