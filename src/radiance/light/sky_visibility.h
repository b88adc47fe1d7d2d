// What each fragment sees of an environment past the product itself.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/sphere_lookup.h"
#include "radiance/smooth_runs.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

/// How many directions a fragment looks in. Most of a product is open, and a few are enough to see
/// that; in a wheel or under an arch, where little of the sky is left, few are pepper.
struct SkyRays {
    int first = 16;  ///< at most 64
    int more = 0;    ///< where the first are noisy, a multiple of 64; 0: nobody looks again. A
                     ///< fragment that is less than half of its pixel looks in fewer
    bool joints_only = false;  ///< only fragments that are a part of their pixel look at all
};

/// Cosine-weighted directions of a fragment, of which some meet the product again. Independent of
/// the environment: solved once for a pose.
struct SkyVisibility {
    SkyRays rays;
    /// Bit k: direction k meets the product. Between two ends of a run that see everything nobody
    /// looks.
    std::vector<std::uint64_t> blocked;
    /// Fragments that looked again, in their order, each direction around the normal of the
    /// sub-sample that it starts from; where the words of each begin in `more`, and where the last
    /// one's end; 64 directions a word, bits as in `blocked`.
    std::vector<std::uint32_t> again, more_begin;
    std::vector<std::uint64_t> more;

    /// The share of the first directions that meet nothing.
    float openness(std::size_t fragment) const;
    /// The same of the directions that a fragment looked in again, by its place in `again`.
    float openness_again(std::size_t at) const;
};
SkyVisibility solve_sky_visibility(const Mesh& mesh,
                                   const Tracer& tracer,
                                   const SurfaceMap& map,
                                   const SmoothRuns& runs,
                                   const SkyRays& rays,
                                   const Progress& progress = {});

/// What is hidden of the light from all around: what comes from those directions, or, in a tenth of
/// the time and for what is dragged, as large a share of all light as of all directions.
enum class Hidden { light, share };
/// What a white diffuser at each fragment sends under the environment: the exact unoccluded value
/// less what is hidden. Without `visibility`, unoccluded. `runs` are the map's.
std::vector<glm::vec3> sky_at_fragments(const Mesh& mesh,
                                        const SurfaceMap& map,
                                        const Environment& environment,
                                        const FilteredEnvironment& filtered,
                                        const SkyVisibility* visibility,
                                        Hidden hidden,
                                        const SmoothRuns& runs);

/// The shading normal of a fragment's k-th sub-sample, on the seen side.
glm::vec3 sample_normal(const Mesh& mesh,
                        const SurfaceMap& map,
                        std::size_t fragment,
                        std::size_t k);

/// Unit direction from which a fragment is shaded for the eye (shaders/bsdf/seen_from.glsl).
glm::vec3 toward_eye(const Fragment& fragment, glm::dvec3 eye_mm);

}  // namespace livery
