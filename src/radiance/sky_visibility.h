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

/// How many directions a fragment looks in. Most of a product is open, and a few are enough to see
/// that; in a wheel or under an arch, where little of the sky is left, few are pepper.
struct SkyRays {
    int first = 16;  ///< at most 64
    int more = 0;    ///< where the first are noisy, a multiple of 64; 0: nobody looks again
    bool joints_only = false;  ///< only fragments that are a part of their pixel look at all
};

/// Cosine-weighted directions of a fragment, of which some meet the product again. Independent of
/// the environment: solved once for a pose.
struct SkyVisibility {
    SkyRays rays;
    std::vector<std::uint64_t> blocked;  ///< bit k: direction k meets the product
    /// Fragments that looked again, in their order, each direction around the normal of the
    /// sub-sample that it starts from; and rays.more / 64 words of each, bits as in `blocked`.
    std::vector<std::uint32_t> again;
    std::vector<std::uint64_t> more;

    /// The share of the first directions that meet nothing.
    float openness(std::size_t fragment) const;
};
SkyVisibility solve_sky_visibility(const Mesh& mesh,
                                   const Tracer& tracer,
                                   const SurfaceMap& map,
                                   const SkyRays& rays,
                                   const Progress& progress = {});

/// What a white diffuser at each fragment sends under the environment: the exact unoccluded value
/// less the mean over the blocked directions. Without `visibility`, unoccluded.
std::vector<glm::vec3> sky_at_fragments(const Mesh& mesh,
                                        const SurfaceMap& map,
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
