// What the rays of mirrors that meet the product meet: points between which light is exchanged.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "radiance/light/exchange_nodes.h"
#include "radiance/light/mirror_visibility.h"

namespace livery {

struct MirrorHits {
    static constexpr std::uint32_t kInside = std::numeric_limits<std::uint32_t>::max();

    /// Of each fragment, its word's set bits in rising order, from `first` on; then of each that
    /// looks for itself those of its other words, from `first_alone` on.
    std::vector<std::uint32_t> first, first_alone;
    std::vector<std::uint32_t> nodes;  ///< kInside: the inside of a closed surface, which is dark
};

/// Of all that was traced so far.
MirrorHits find_mirror_hits(const Mesh& mesh,
                            const Tracer& tracer,
                            const SurfaceMap& map,
                            glm::dvec3 eye_mm,
                            const MirrorVisibility& visibility,
                            const ExchangeNodes& nodes,
                            const Progress& progress);

/// What the product sends into mirrors: of each node, working space.
struct MirroredProduct {
    const MirrorHits* hits = nullptr;
    std::span<const glm::vec3> sent;

    glm::vec3 light(std::uint32_t hit) const {
        const std::uint32_t node = hits->nodes[hit];
        return node == MirrorHits::kInside ? glm::vec3(0.0f) : sent[node];
    }
};

}  // namespace livery
