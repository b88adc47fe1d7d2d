// What each fragment sees of an environment past the product itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/environment_filter.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

/// Cosine-weighted directions of a fragment, of which some meet the product again. Independent of
/// the environment: solved once for a pose.
struct SkyVisibility {
    int directions = 0;                  ///< a fragment, at most 64
    std::vector<std::uint64_t> blocked;  ///< bit k: direction k meets the product
};
SkyVisibility solve_sky_visibility(const Mesh& mesh,
                                   const Tracer& tracer,
                                   const SurfaceMap& map,
                                   int directions,
                                   const Progress& progress = {});

/// What a white diffuser at each fragment sends under the environment: the exact unoccluded value
/// less the mean over the blocked directions. Without `visibility`, unoccluded.
std::vector<glm::vec3> sky_at_fragments(const SurfaceMap& map,
                                        const Environment& environment,
                                        const FilteredEnvironment& filtered,
                                        const SkyVisibility* visibility);

/// Slope parameters at which openness toward the mirrored direction is solved.
inline constexpr std::array<double, 3> kMirrorAlphas{0.02, 0.1, 0.4};

/// Of each fragment the share of a mirror's lobe that leaves the product, for kMirrorAlphas.
std::vector<glm::vec3> solve_mirror_openness(const Mesh& mesh,
                                             const Tracer& tracer,
                                             const SurfaceMap& map,
                                             glm::dvec3 eye_mm,
                                             int rays_a_lobe,
                                             const Progress& progress = {});

/// Unit direction from a fragment to the eye; kept above the horizon of its normal by 1e-4.
glm::vec3 toward_eye(const Fragment& fragment, glm::dvec3 eye_mm);

}  // namespace livery
