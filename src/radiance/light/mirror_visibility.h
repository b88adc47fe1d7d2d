// The rays of mirrors: the normals of a pixel that mirror, which rays around the mirrored eye meet
// the product, and what those meet sends along them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/progress.h"
#include "radiance/light/interreflection.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/smooth_runs.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

static_assert(MirrorQuadrature::kFacets == kSamplesAFragment);

/// One of the normals of a pixel and the nodes around it.
struct Facet {
    glm::vec3 x, y, normal, wo;
    MirrorQuadrature::Row row;
    float variance = 0.0f;  ///< that its own spread of normals adds to its nodes'

    Facet(const Fragment& fragment,
          const glm::vec3& its_normal,
          float slope_variance,
          const glm::dvec3& eye_mm,
          const MirrorQuadrature& quadrature);

    /// Where the eye's direction is mirrored to by a node.
    glm::vec3 mirrored(std::size_t node) const;
};

using Facets = std::array<Facet, kSamplesAFragment>;

/// Every one the fragment's mean.
Facets even_facets(const Fragment& f, const glm::dvec3& eye_mm, const MirrorQuadrature& nodes);

/// One a sub-sample, moved together so that their mean is the fragment's: that is a mean over more
/// samples, and goes on more smoothly from pixel to pixel.
Facets facets_of(const Mesh& mesh,
                 const SurfaceMap& map,
                 std::size_t index,
                 const glm::dvec3& eye_mm,
                 const MirrorQuadrature& nodes);

struct MirrorVisibility {
    MirrorQuadrature quadrature;
    std::vector<bool> parts;             ///< whose fragments were traced; others see everything
    std::vector<std::uint64_t> blocked;  ///< a word a fragment, of MirrorQuadrature::Ray's bits
    /// A fragment that cannot learn from its neighbours: the words of every other turn, from its
    /// own on.
    struct Alone {
        std::uint32_t fragment = 0;
        std::array<std::uint64_t, MirrorQuadrature::kTurns / 2> blocked{};
    };
    std::vector<Alone> alone;  ///< by fragment

    /// Nothing is traced yet; so many nodes a ring.
    MirrorVisibility(const SurfaceMap& map, std::size_t part_count, int nodes);
};

/// Traces the fragments of these parts, where they were not. After a stop nothing has changed.
/// Between two ends of the map's `runs` from which nothing is hidden, nobody looks.
void add_mirror_visibility(const Mesh& mesh,
                           const Tracer& tracer,
                           const SurfaceMap& map,
                           const SmoothRuns& runs,
                           glm::dvec3 eye_mm,
                           const std::vector<bool>& parts,
                           const Progress& progress,
                           MirrorVisibility& visibility);

struct MirrorHits {
    static constexpr std::uint32_t kInside = std::numeric_limits<std::uint32_t>::max();

    /// Of each fragment, its word's set bits in rising order, from `first` on; then of each that
    /// looks for itself those of its other words, from `first_alone` on.
    std::vector<std::uint32_t> first, first_alone;
    std::vector<std::uint32_t>
        rays;  ///< of nodes; kInside: within a closed surface, where it is dark
};

/// Of all that was traced so far.
MirrorHits find_mirror_hits(const Mesh& mesh,
                            const Tracer& tracer,
                            const SurfaceMap& map,
                            glm::dvec3 eye_mm,
                            const MirrorVisibility& visibility,
                            const NodeExchange& exchange,
                            const Progress& progress);

/// What the product sends into mirrors, working space.
struct MirroredProduct {
    const MirrorHits* hits = nullptr;
    const NodeLight* sent = nullptr;

    glm::vec3 light(std::uint32_t hit) const {
        const std::uint32_t ray = hits->rays[hit];
        return ray == MirrorHits::kInside ? glm::vec3(0.0f) : sent->along(ray);
    }
};

}  // namespace livery
