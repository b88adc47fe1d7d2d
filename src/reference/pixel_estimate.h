// What the samples of one pixel say: their mean, and how far it may be off.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

namespace livery {

/// Sums over the samples that met the product. Samples of a pixel are points of one well-spread
/// sequence, so that their own scatter says far too much of their mean's error; that of the means
/// of 8 to 16 batches of consecutive samples, each as well spread in itself, says only a little too
/// much. Batches start as single samples and are joined in pairs as they fill up.
struct PixelEstimate {
    static constexpr std::uint32_t kBatches = 16;

    glm::dvec3 colour_sum{0.0};
    std::uint32_t traced = 0, covered = 0;
    std::uint32_t batch_length = 1;
    std::array<std::uint32_t, kBatches> batch_covered{};
    std::array<float, kBatches> batch_luminance{};  ///< sums

    /// One more sample, of a path or (null) beside the product.
    void add(const glm::dvec3* value, double luminance);
};

/// Of the mean luminance of the covered samples.
struct EstimateError {
    double standard_error = 0.0;  ///< infinite below two batches
    double half_width = 0.0;      ///< of the 95% confidence interval (Student's t)
};
EstimateError error_of(const PixelEstimate& estimate);

}  // namespace livery
