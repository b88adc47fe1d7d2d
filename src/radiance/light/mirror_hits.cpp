#include "radiance/light/mirror_hits.h"

#include <bit>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "radiance/fragment_neighbours.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/mirror_facets.h"

namespace livery {

namespace {

std::uint32_t count_of(std::uint64_t word) {
    return static_cast<std::uint32_t>(std::popcount(word));
}

/// Prefix sums of `count(i)`, from `start` on.
template <typename Count>
std::vector<std::uint32_t> places_of(std::size_t size, std::uint32_t start, const Count& count) {
    std::vector<std::uint32_t> first(size + 1, start);
    for (std::size_t i = 0; i < size; ++i) first[i + 1] = first[i] + count(i);
    return first;
}

/// Those of the rays of a fragment that are known to meet the product. For one thread.
class HitRays {
  public:
    HitRays(const Mesh& mesh,
            const Tracer& tracer,
            const SurfaceMap& map,
            const glm::dvec3& eye_mm,
            const MirrorQuadrature& quadrature,
            const ExchangeNodes& nodes)
        : mesh_(mesh),
          tracer_(tracer),
          map_(map),
          eye_mm_(eye_mm),
          quadrature_(quadrature),
          nodes_(nodes) {}

    void begin(std::size_t fragment) {
        facets_.emplace(facets_of(mesh_, map_, fragment, eye_mm_, quadrature_));
        ray_origins(mesh_, map_, fragment, origins_);
    }
    /// Of the set bits of a turn's word.
    void trace(std::size_t turn, std::uint64_t word, std::uint32_t* to) const {
        const std::vector<std::size_t>& traced = quadrature_.traced(turn);
        for (; word != 0; word &= word - 1) {
            const std::size_t k = traced[static_cast<std::size_t>(std::countr_zero(word))];
            TraceRay ray;
            ray.origin = origins_[k % origins_.size()];
            ray.direction = (*facets_)[k % facets_->size()].mirrored(k);
            *to++ = node_of(ray);
        }
    }

  private:
    std::uint32_t node_of(const TraceRay& ray) const {
        const Hit hit = tracer_.closest(ray);
        // Rounded otherwise than when it was traced
        if (!hit.valid()) return MirrorHits::kInside;
        const glm::vec3 facing = surface_point(mesh_, hit).geometric_normal;
        if (glm::dot(facing, ray.direction) >= 0.0f) return MirrorHits::kInside;
        const auto around = nodes_.points.around(mesh_, hit.triangle, hit.barycentric);
        const ExchangePoints::Share* nearest = &around[0];
        for (const ExchangePoints::Share& share : around) {
            if (share.weight > nearest->weight) nearest = &share;
        }
        return nodes_.node_of[nearest->index];
    }

    const Mesh& mesh_;
    const Tracer& tracer_;
    const SurfaceMap& map_;
    const glm::dvec3& eye_mm_;
    const MirrorQuadrature& quadrature_;
    const ExchangeNodes& nodes_;
    std::optional<Facets> facets_;
    std::array<glm::vec3, kSamplesAFragment> origins_;
};

}  // namespace

MirrorHits find_mirror_hits(const Mesh& mesh,
                            const Tracer& tracer,
                            const SurfaceMap& map,
                            glm::dvec3 eye_mm,
                            const MirrorVisibility& visibility,
                            const ExchangeNodes& nodes,
                            const Progress& progress) {
    MirrorHits hits;
    const std::vector<std::uint64_t>& blocked = visibility.blocked;
    hits.first = places_of(blocked.size(), 0, [&](std::size_t i) { return count_of(blocked[i]); });
    const auto& alone = visibility.alone;
    hits.first_alone = places_of(alone.size(), hits.first.back(), [&](std::size_t i) {
        std::uint32_t count = 0;
        for (std::size_t word = 1; word < alone[i].blocked.size(); ++word) {
            count += count_of(alone[i].blocked[word]);
        }
        return count;
    });
    hits.nodes.resize(hits.first_alone.back());
    const auto rays = [&] {
        return HitRays(mesh, tracer, map, eye_mm, visibility.quadrature, nodes);
    };
    parallel_for(blocked.size(), 2048, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        HitRays own = rays();
        for (std::size_t i = begin; i < end; ++i) {
            if (blocked[i] == 0) continue;
            own.begin(i);
            own.trace(neighbour_turn(map, i), blocked[i], &hits.nodes[hits.first[i]]);
        }
    });
    parallel_for(alone.size(), 256, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        HitRays own = rays();
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t fragment = alone[i].fragment;
            own.begin(fragment);
            std::uint32_t place = hits.first_alone[i];
            for (std::size_t word = 1; word < alone[i].blocked.size(); ++word) {
                const std::size_t turn =
                    (neighbour_turn(map, fragment) + 2 * word) % kNeighbourTurns;
                if (alone[i].blocked[word] == 0) continue;
                own.trace(turn, alone[i].blocked[word], &hits.nodes[place]);
                place += count_of(alone[i].blocked[word]);
            }
        }
    });
    return hits;
}

}  // namespace livery
