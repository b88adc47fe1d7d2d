// Equations 3 to 7: what the projector's channels mix to in the camera's, pixel by pixel.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "calibration/colour/colour_samples.h"

namespace livery {

/// Mixing matrices of a larger condition number are not inverted.
inline constexpr double kMixingConditionLimit = 10.0;

/// N = (unmixing C - dark) / span, one a sample.
struct PixelMixing {
    std::vector<glm::mat3> unmixing;    ///< Vn^-1
    std::vector<glm::vec3> dark;        ///< Vn^-1 C_S
    std::vector<glm::vec3> span;        ///< Vn^-1 (C_T - C_S)
    std::vector<glm::vec3> span_sigma;  ///< standard deviation of its noise
    std::vector<float> condition;       ///< of Vn

    void resize(std::size_t count);
};

struct PooledMixing {
    glm::dmat3 vn{1.0};  ///< unit diagonal; column: projector channel
    glm::dvec3 bright{0.0}, red{0.0}, green{0.0}, blue{0.0};  ///< mean differences to dark-gray
    double additivity_error = 0.0;  ///< |T - S - sum (K - S)| / |T - S| of the means
    double spread = 0.0;            ///< scatter of Vn over its noise; 1: noise alone
    bool neutral = false;           ///< the scatter is small: one Vn serves all pixels
};

/// Sums over the well-lit pixels. Throws Refused when there are none, or when a channel's picture
/// is no brighter than dark-gray.
PooledMixing pool_mixing(const ColourSamples& samples);

/// The method as published: each pixel from its own five values.
PixelMixing mix_by_pixel(const ColourSamples& samples);

/// One Vn where the surface is neutral, each pixel's own as far as it stands out of the noise; one
/// scale a pixel from all differences. `additive`: white is the sum of the channels.
PixelMixing mix_robustly(const ColourSamples& samples, const PooledMixing& pooled, bool additive);

/// Ratio of the largest to the smallest singular value; infinity when singular.
double condition_number(const glm::dmat3& matrix);

}  // namespace livery
