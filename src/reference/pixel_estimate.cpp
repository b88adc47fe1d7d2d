#include "reference/pixel_estimate.h"

#include <cmath>
#include <limits>

namespace livery {

namespace {

/// 97.5% quantiles of Student's t for 1 to 15 degrees of freedom.
constexpr std::array<double, PixelEstimate::kBatches - 1> kStudent{12.706,
                                                                   4.303,
                                                                   3.182,
                                                                   2.776,
                                                                   2.571,
                                                                   2.447,
                                                                   2.365,
                                                                   2.306,
                                                                   2.262,
                                                                   2.228,
                                                                   2.201,
                                                                   2.179,
                                                                   2.160,
                                                                   2.145,
                                                                   2.131};

void join_pairs(PixelEstimate& estimate) {
    constexpr std::uint32_t half = PixelEstimate::kBatches / 2;
    for (std::uint32_t b = 0; b < half; ++b) {
        estimate.batch_covered[b] =
            estimate.batch_covered[2 * b] + estimate.batch_covered[2 * b + 1];
        estimate.batch_luminance[b] =
            estimate.batch_luminance[2 * b] + estimate.batch_luminance[2 * b + 1];
    }
    for (std::uint32_t b = half; b < PixelEstimate::kBatches; ++b) {
        estimate.batch_covered[b] = 0;
        estimate.batch_luminance[b] = 0.0f;
    }
    estimate.batch_length *= 2;
}

}  // namespace

void PixelEstimate::add(const glm::dvec3* value, double luminance) {
    if (traced == kBatches * batch_length) join_pairs(*this);
    const std::uint32_t batch = traced / batch_length;
    ++traced;
    if (!value) return;
    ++covered;
    colour_sum += *value;
    ++batch_covered[batch];
    batch_luminance[batch] += static_cast<float>(luminance);
}

EstimateError error_of(const PixelEstimate& estimate) {
    double sum = 0.0, weight = 0.0;
    for (std::uint32_t b = 0; b < PixelEstimate::kBatches; ++b) {
        sum += static_cast<double>(estimate.batch_luminance[b]);
        weight += estimate.batch_covered[b];
    }
    const double mean = sum / weight;
    // A ratio's scatter: batches at a silhouette hold different numbers of samples.
    double squares = 0.0;
    int batches = 0;
    for (std::uint32_t b = 0; b < PixelEstimate::kBatches; ++b) {
        if (estimate.batch_covered[b] == 0) continue;
        const double off =
            static_cast<double>(estimate.batch_luminance[b]) - mean * estimate.batch_covered[b];
        squares += off * off;
        ++batches;
    }
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    if (batches < 2) return {kInfinite, kInfinite};
    EstimateError error;
    error.standard_error = std::sqrt(squares * batches / (batches - 1.0)) / weight;
    error.half_width = error.standard_error * kStudent[static_cast<std::size_t>(batches - 2)];
    return error;
}

}  // namespace livery
