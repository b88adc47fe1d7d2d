// What each fragment mirrors of an environment past the product itself.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/fragment_neighbours.h"
#include "radiance/light/environment_filter.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/light/sphere_lookup.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

/// Which rays of each fragment meet the product: independent of the environment.
struct MirrorVisibility {
    MirrorQuadrature quadrature;
    std::vector<std::uint64_t> blocked;  ///< a word a fragment, of MirrorQuadrature::Ray's bits
    /// Fragments that cannot learn from their neighbours, in their order, and the words of every
    /// other turn of each, from its own on.
    std::vector<std::uint32_t> alone;
    static constexpr std::size_t kWordsAlone = MirrorQuadrature::kTurns / 2;
    std::vector<std::array<std::uint64_t, kWordsAlone>> blocked_alone;
};
MirrorVisibility solve_mirror_visibility(const Mesh& mesh,
                                         const Tracer& tracer,
                                         const SurfaceMap& map,
                                         glm::dvec3 eye_mm,
                                         int nodes,
                                         const Progress& progress = {});

struct MirroredLight {
    std::array<glm::vec3, kMirrorAlphas.size()> lobe;
    /// Of kHalfAngleLobes, then kEntryLobes: how many times as much of the light stands where
    /// Fresnel's term is high as does of even light.
    std::array<glm::vec3, kGrazingLayers> grazing;
};

/// Mean radiance of the environment over fragments' mirror lobes, one for each of kMirrorAlphas,
/// times mirror_correction().
class MirroredEnvironment {
  public:
    /// Without `visibility` nothing is hidden, and a pixel has one normal.
    MirroredEnvironment(const Environment& environment,
                        const FilteredEnvironment& filtered,
                        const Mesh& mesh,
                        const SurfaceMap& map,
                        glm::dvec3 eye_mm,
                        const MirrorVisibility* visibility);

    /// For one thread.
    class Scratch {
        friend class MirroredEnvironment;
        std::vector<FragmentNeighbours::Neighbour> neighbours;
        std::vector<float> seen;   ///< share of each node
        std::vector<float> width;  ///< of its Gaussian's variance
    };
    MirroredLight at_fragment(std::size_t fragment, Scratch& scratch) const;

  private:
    /// Whether any node is hidden, and by how much each.
    bool find_seen(std::size_t fragment, Scratch& scratch) const;
    void ask_neighbours(std::size_t fragment, Scratch& scratch) const;
    void ask_itself(std::size_t fragment, const std::uint64_t* words, Scratch& scratch) const;

    float scale_;
    SpherePlaces places_;
    GaussianLayers layers_;
    const Mesh& mesh_;
    const SurfaceMap& map_;
    glm::dvec3 eye_mm_;
    const MirrorVisibility* visibility_;
    std::optional<MirrorQuadrature> unoccluded_;
    const MirrorQuadrature& quadrature_;
    std::optional<FragmentNeighbours> neighbours_;
};

}  // namespace livery
