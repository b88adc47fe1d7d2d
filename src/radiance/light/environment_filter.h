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

/// Gaussians, the map itself under the first: the narrowest, in rad along each axis, is a texel
/// wide, and the variance of each is twice that of the one before.
inline constexpr float kFirstGaussian_rad = 0.0125f;
inline constexpr std::size_t kGaussianLayers = 14;

/// Texels of the layers of either kind that filtering writes.
inline constexpr int kFilterTexels = 7 * 512 * 256 + 7 * 128 * 64;

/// All in the map's own frame (no rotation) and units (no scale), latitude-longitude.
struct FilteredEnvironment {
    /// One a layer: mean over the GGX lobe seen along the normal; fewer texels for wide lobes.
    std::vector<ImageF> mirrored;
    /// The same of Gaussians: what MirrorQuadrature's nodes look up.
    std::vector<ImageF> gaussians;
    ImageF diffuse;  ///< what a white diffuser facing there sends: irradiance / pi
    /// Gaussians of .1 and .06 rad: the mean around one of a few dozen and of a hundred stratified
    /// directions. Past an edge, as much of the hidden light as lies within one is seen.
    ImageF blurred, hardly_blurred;
};

/// Only the parts asked for are made (the others stay empty). Filtering is exact up to degree 255
/// of the spherical harmonics: a lobe of alpha .02 loses under 1e-3 of its energy there.
struct FilterParts {
    bool mirrored = true, diffuse = true, blurred = true, gaussians = true;
};
FilteredEnvironment filter_environment(const Environment& environment,
                                       const FilterParts& parts,
                                       const Progress& progress = {});

/// Bilinear, wrapped in azimuth.
glm::vec3 sample_sphere(const ImageF& picture, const glm::dvec2& uv);

/// Degrees 0, 1, ... of the lobe's Legendre series, 1 at degree 0, up to the last over 1e-6.
std::vector<double> ggx_lobe_kernel(double alpha, int degree);

}  // namespace livery
