// An environment as surfaces of each roughness mirror it, and as a diffuser sees it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/progress.h"
#include "scene/look.h"

namespace livery {

/// Slope parameters of the filtered layers: the map itself, then steps of sqrt(2).
inline constexpr std::array<float, 14> kLayerAlphas{0.0f,
                                                    0.0141421f,
                                                    0.02f,
                                                    0.0282843f,
                                                    0.04f,
                                                    0.0565685f,
                                                    0.08f,
                                                    0.113137f,
                                                    0.16f,
                                                    0.226274f,
                                                    0.32f,
                                                    0.452548f,
                                                    0.64f,
                                                    0.905097f};

/// Texels of the layers that filtering writes.
inline constexpr int kFilterTexels = 7 * 512 * 256 + 7 * 128 * 64;

/// All in the map's own frame (no rotation) and units (no scale), latitude-longitude.
struct FilteredEnvironment {
    /// One a layer: mean over the GGX lobe seen along the normal; fewer texels for wide lobes.
    std::vector<ImageF> mirrored;
    ImageF diffuse;  ///< what a white diffuser facing there sends: irradiance / pi
    ImageF blurred;  ///< 0.1 rad Gaussian: the mean over one of many stratified directions
};

/// Only the parts asked for are made (the others stay empty). Filtering is exact up to degree 255
/// of the spherical harmonics: a lobe of alpha .02 loses under 1e-3 of its energy there.
struct FilterParts {
    bool mirrored = true, diffuse = true, blurred = true;
};
FilteredEnvironment filter_environment(const Environment& environment,
                                       const FilterParts& parts,
                                       const Progress& progress = {});

/// The layer under alpha and the weight of the one after it.
struct LayerShare {
    std::size_t below = 0;
    float share = 0.0f;
};
inline LayerShare layer_of(float alpha) {
    constexpr float kFirst = kLayerAlphas[1];
    const float last = static_cast<float>(kLayerAlphas.size() - 1);
    const float layer = alpha < kFirst ? alpha / kFirst : 1.0f + 2.0f * std::log2(alpha / kFirst);
    const float below = std::floor(std::min(layer, last - 1e-3f));
    return {static_cast<std::size_t>(below), std::min(layer - below, 1.0f)};
}

/// Bilinear, wrapped in azimuth.
glm::vec3 sample_sphere(const ImageF& picture, const glm::dvec2& uv);

/// Interpolated between the layers to either side of alpha.
glm::vec3 sample_layers(const FilteredEnvironment& filtered, const glm::dvec2& uv, float alpha);

/// Degrees 0, 1, ... of the lobe's Legendre series, 1 at degree 0, up to the last over 1e-6.
std::vector<double> ggx_lobe_kernel(double alpha, int degree);

}  // namespace livery
