// Visibility, solved once for a pose: what of the product each projector pixel lights.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/image.h"
#include "core/progress.h"
#include "mesh/mesh.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

/// The part of one projector pixel that one part of the product fills.
struct Fragment {
    glm::vec3 position_mm{0.0f};
    glm::vec3 normal{0.0f};        ///< unit mean normal
    float normal_variance = 0.0f;  ///< widens alpha: mean squared slope around the mean normal
    glm::vec4 tangent{0.0f};
    float coverage = 0.0f;    ///< of the pixel's area
    std::uint32_t pixel = 0;  ///< y * width + x
    std::uint16_t part = 0;
};

/// Where a sub-sample met the mesh. Shadow rays start at such points: a mean of several may lie
/// inside the product.
struct SurfaceSample {
    std::uint32_t triangle = 0;
    glm::vec2 barycentric{0.0f};  ///< as in Hit
};
inline constexpr std::size_t kSamplesAFragment = 4;

/// Fragments sorted by part, then by pixel, so that a paint change re-shades one contiguous range.
struct SurfaceMap {
    int width = 0, height = 0;
    std::vector<Fragment> fragments;
    /// kSamplesAFragment each, spread over the fragment, with repeats where it had fewer
    std::vector<SurfaceSample> samples;
    /// The fragments' normals without the relief that tilts them; empty where none does.
    std::vector<glm::vec3> flat_normals;
    std::vector<std::uint32_t> part_begin;  ///< parts + 1 offsets into fragments
    int samples_per_pixel = 0;
    ImageF coverage;                 ///< one channel, of each pixel, all parts together
    std::size_t covered_pixels = 0;  ///< pixels with any coverage
};

/// `samples_per_pixel` rays a pixel (a square number, 16 or more) through the view's full lens
/// model.
SurfaceMap build_surface_map(const Mesh& mesh,
                             const Tracer& tracer,
                             const View& view,
                             int samples_per_pixel,
                             const Progress& progress = {});

}  // namespace livery
