// What each fragment sees of an environment past the product itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/environment_filter.h"
#include "radiance/sphere_lookup.h"
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

/// Slope parameters for which each fragment keeps what it mirrors; paints in between interpolate.
inline constexpr std::array<float, 10> kMirrorAlphas{
    0.01f, 0.02f, 0.03f, 0.045f, 0.07f, 0.11f, 0.18f, 0.3f, 0.5f, 1.0f};

/// Which rays of each fragment's mirror lobes meet the product: independent of the environment.
/// With `sky`, fragments none of whose sky directions are blocked are taken as open.
struct MirrorVisibility {
    int rays = 0;                        ///< a lobe, at most 16
    std::vector<std::uint16_t> blocked;  ///< kMirrorAlphas.size() words a fragment; bit k: ray k
};
int mirror_rays(int rays_a_wide_lobe);  ///< that a fragment costs
MirrorVisibility solve_mirror_visibility(const Mesh& mesh,
                                         const Tracer& tracer,
                                         const SurfaceMap& map,
                                         glm::dvec3 eye_mm,
                                         int rays_a_lobe,
                                         const SkyVisibility* sky,
                                         const Progress& progress = {});

/// Mean radiance of the environment over a fragment's mirror lobes, one for each of kMirrorAlphas:
/// over the visibility's own samples; without `visibility`, unoccluded, as round lobes widened by
/// the fragment's normals.
class MirroredEnvironment {
  public:
    MirroredEnvironment(const Environment& environment, const FilteredEnvironment& filtered);

    std::array<glm::vec3, kMirrorAlphas.size()> at_fragment(
        const Mesh& mesh,
        const SurfaceMap& map,
        std::size_t fragment,
        glm::dvec3 eye_mm,
        const MirrorVisibility* visibility) const;

  private:
    float scale_;
    SpherePlaces places_;
    MirroredLayers layers_;
};

/// The shading normal of a fragment's k-th sub-sample, on the seen side.
glm::vec3 sample_normal(const Mesh& mesh,
                        const SurfaceMap& map,
                        std::size_t fragment,
                        std::size_t k);

/// Unit direction from a fragment to the eye; kept above the horizon of its normal by 1e-4.
glm::vec3 toward_eye(const Fragment& fragment, glm::dvec3 eye_mm);

}  // namespace livery
