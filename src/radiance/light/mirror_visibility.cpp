#include "radiance/light/mirror_visibility.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"
#include "radiance/fragment_neighbours.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/mirror_facets.h"

namespace livery {
namespace {

static_assert(MirrorQuadrature::kTurns == kNeighbourTurns);

/// Rays from fragments along the directions that nodes mirror to. For one thread.
class NodeRays {
  public:
    NodeRays(const Mesh& mesh,
             const Tracer& tracer,
             const SurfaceMap& map,
             const glm::dvec3& eye_mm,
             const MirrorQuadrature& quadrature)
        : mesh_(mesh), tracer_(tracer), map_(map), eye_mm_(eye_mm), quadrature_(quadrature) {}

    /// Bits of the nodes of these turns that the product hides, a word a turn.
    void trace(std::size_t fragment,
               std::span<const std::size_t> turns,
               std::span<std::uint64_t> hidden) {
        const Facets facets = facets_of(mesh_, map_, fragment, eye_mm_, quadrature_);
        ray_origins(mesh_, map_, fragment, origins_);
        rays_.clear();
        bits_.clear();
        for (std::size_t word = 0; word < turns.size(); ++word) {
            hidden[word] = 0;
            const std::vector<std::size_t>& nodes = quadrature_.traced(turns[word]);
            for (std::size_t bit = 0; bit < nodes.size(); ++bit) {
                const std::size_t k = nodes[bit];
                const Facet& facet = facets[k % facets.size()];
                if (!facet.row.has_weight(k)) continue;
                TraceRay& ray = rays_.emplace_back();
                ray.origin = origins_[k % origins_.size()];
                ray.direction = facet.mirrored(k);
                bits_.emplace_back(word, bit);
            }
        }
        blocked_.resize(rays_.size());
        tracer_.occluded(rays_, blocked_, RayOrder::scattered);
        for (std::size_t k = 0; k < rays_.size(); ++k) {
            const auto [word, bit] = bits_[k];
            if (blocked_[k]) hidden[word] |= std::uint64_t{1} << bit;
        }
    }

  private:
    const Mesh& mesh_;
    const Tracer& tracer_;
    const SurfaceMap& map_;
    const glm::dvec3& eye_mm_;
    const MirrorQuadrature& quadrature_;
    std::vector<TraceRay> rays_;
    std::vector<std::pair<std::size_t, std::size_t>> bits_;  ///< word and bit of each ray
    std::vector<std::uint8_t> blocked_;
    std::array<glm::vec3, kSamplesAFragment> origins_;
};

using Indices = std::vector<std::uint32_t>;

/// Fragments of some parts.
Indices fragments_of(const SurfaceMap& map, const std::vector<bool>& parts) {
    Indices fragments;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (!parts[p]) continue;
        for (std::uint32_t i = map.part_begin[p]; i < map.part_begin[p + 1]; ++i) {
            fragments.push_back(i);
        }
    }
    return fragments;
}

/// Fragments that look for themselves, where something is hidden: no neighbour has traced some of
/// the directions, and those traced that come closest are up to a quarter of a ring away; or more
/// than half is hidden, as in a wheel, where a neighbour looks through another gap.
Indices find_alone(const SurfaceMap& map,
                   const MirrorQuadrature& quadrature,
                   const Indices& among,
                   std::span<const std::uint64_t> blocked) {
    const FragmentNeighbours neighbours(map);
    std::vector<std::uint8_t> is_alone(among.size(), 0);
    parallel_for(is_alone.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<FragmentNeighbours::Neighbour> found;
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = among[k];
            neighbours.around(i, found);
            unsigned turns = 0;
            bool hidden = false;
            for (const FragmentNeighbours::Neighbour& one : found) {
                turns |= 1u << one.turn;
                hidden = hidden || blocked[one.fragment] != 0;
            }
            const auto own = static_cast<std::size_t>(std::popcount(blocked[i]));
            const bool deep = 2 * own > quadrature.traced(neighbour_turn(map, i)).size();
            is_alone[k] = hidden && (turns != (1u << kNeighbourTurns) - 1u || deep);
        }
    });
    Indices alone;
    for (std::size_t k = 0; k < is_alone.size(); ++k) {
        if (is_alone[k]) alone.push_back(among[k]);
    }
    return alone;
}

}  // namespace

MirrorVisibility::MirrorVisibility(const SurfaceMap& map, std::size_t part_count, int nodes)
    : quadrature(mirror_rings(nodes)), parts(part_count, false), blocked(map.fragments.size(), 0) {}

void add_mirror_visibility(const Mesh& mesh,
                           const Tracer& tracer,
                           const SurfaceMap& map,
                           const SmoothRuns& runs,
                           glm::dvec3 eye_mm,
                           const std::vector<bool>& parts,
                           const Progress& progress,
                           MirrorVisibility& visibility) {
    std::vector<bool> missing(parts.size());
    for (std::size_t p = 0; p < parts.size(); ++p) missing[p] = parts[p] && !visibility.parts[p];
    const Indices fragments = fragments_of(map, missing);
    const MirrorQuadrature& quadrature = visibility.quadrature;
    const auto trace = [&](const auto& each) {
        progress.check_stop();
        NodeRays rays(mesh, tracer, map, eye_mm, quadrature);
        each([&](std::size_t i) {
            const std::size_t turn = neighbour_turn(map, i);
            rays.trace(i, {&turn, 1}, {&visibility.blocked[i], 1});
        });
    };
    for (std::size_t p = 0; p < missing.size(); ++p) {
        if (!missing[p]) continue;
        const std::size_t first = map.part_begin[p], count = map.part_begin[p + 1] - first;
        parallel_for(count, 512, [&](std::size_t begin, std::size_t end) {
            trace([&](const auto& ask) { runs.ends(first + begin, first + end, ask); });
        });
        for (const SmoothRuns::Line line : SmoothRuns::kLines) {
            parallel_for(count, 512, [&](std::size_t begin, std::size_t end) {
                trace([&](const auto& ask) {
                    runs.between(line, first + begin, first + end, [&](std::size_t i, auto at) {
                        const bool open =
                            (visibility.blocked[at.first] | visibility.blocked[at.second]) == 0;
                        if (!open) ask(i);
                    });
                });
            });
        }
    }

    // Of their own part alone do fragments learn
    std::vector<MirrorVisibility::Alone> alone;
    for (const std::uint32_t i : find_alone(map, quadrature, fragments, visibility.blocked)) {
        alone.push_back({i, {visibility.blocked[i]}});
    }
    parallel_for(alone.size(), 64, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        NodeRays rays(mesh, tracer, map, eye_mm, quadrature);
        for (std::size_t k = begin; k < end; ++k) {
            std::array<std::size_t, MirrorQuadrature::kTurns / 2 - 1> turns;
            for (std::size_t word = 0; word < turns.size(); ++word) {
                turns[word] =
                    (neighbour_turn(map, alone[k].fragment) + 2 * (word + 1)) % kNeighbourTurns;
            }
            rays.trace(alone[k].fragment, turns, std::span(alone[k].blocked).subspan(1));
        }
    });
    std::vector<MirrorVisibility::Alone> all;
    std::merge(visibility.alone.begin(),
               visibility.alone.end(),
               alone.begin(),
               alone.end(),
               std::back_inserter(all),
               [](const auto& a, const auto& b) { return a.fragment < b.fragment; });
    visibility.alone = std::move(all);
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (missing[p]) visibility.parts[p] = true;
    }
}

}  // namespace livery
