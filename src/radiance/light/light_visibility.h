// How much of each light reaches each fragment: solved when the pose or the light changes.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/smooth_runs.h"
#include "radiance/surface_map.h"
#include "scene/look.h"
#include "tracing/tracer.h"

namespace livery {

/// One light at one fragment. A diffuser of albedo 1 sends radiance x visibility x max(n.l, 0).
struct LightAtFragment {
    glm::vec3 direction{0.0f};  ///< unit; of the visible part's centre
    float visibility = 0.0f;    ///< 1: the whole disc, at the irradiance of its centre
};

/// Shadow rays, at most `rays_per_fragment`, from the fragment's own sub-samples toward hashed,
/// stratified points of the light's disc; those under the horizon of the mean normal do not count.
/// A point at infinity takes one ray a sub-sample, so that shadow edges stay antialiased. Between
/// two ends of the map's `runs` that see all of the light, or none, nobody asks again.
std::vector<LightAtFragment> light_at_fragments(const Mesh& mesh,
                                                const Tracer& tracer,
                                                const SurfaceMap& map,
                                                const SmoothRuns& runs,
                                                const DirectionalLight& light,
                                                int rays_per_fragment,
                                                const Progress& progress = {});

/// The same where nothing hides the light.
std::vector<LightAtFragment> unhidden_light(const SurfaceMap& map, const DirectionalLight& light);

/// Share of a light's disc that a point sees: `ray_count` stratified rays, turned by a hash of
/// `seed`. The horizon of `normal` does not count.
float disc_openness(const Tracer& tracer,
                    const glm::vec3& position_mm,
                    const glm::vec3& normal,
                    const DirectionalLight& light,
                    int ray_count,
                    std::size_t seed);

/// The same of a surface: a ray from each of those places, which lie off it.
float disc_openness(const Tracer& tracer,
                    std::span<const glm::vec3> origins_mm,
                    const DirectionalLight& light,
                    std::size_t seed);

/// Where rays from a fragment start: its first sub-samples, moved off the surface on the seen side.
void ray_origins(const Mesh& mesh,
                 const SurfaceMap& map,
                 std::size_t fragment,
                 std::span<glm::vec3> origins);

}  // namespace livery
