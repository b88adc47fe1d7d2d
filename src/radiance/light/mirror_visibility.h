// Which rays around each fragment's mirror direction meet the product: independent of the
// environment, and of what a part is painted with.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/progress.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/smooth_runs.h"
#include "radiance/surface_map.h"
#include "tracing/tracer.h"

namespace livery {

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

}  // namespace livery
