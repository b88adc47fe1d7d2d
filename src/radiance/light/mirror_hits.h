// What the rays of mirrors that meet the product meet: what nodes send along their own rays.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "radiance/light/interreflection.h"
#include "radiance/light/mirror_visibility.h"

namespace livery {

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
