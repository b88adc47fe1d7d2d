#include "radiance/light/mirror_hits.h"

#include <array>
#include <bit>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "core/random.h"
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

/// Those of the rays of fragments that are known to meet the product, some at a time: few of one
/// fragment do, and none of a packet's lanes is to stay empty. For one thread.
class HitRays {
  public:
    /// What they meet is written from `to` on, in their order.
    HitRays(const Mesh& mesh,
            const Tracer& tracer,
            const SurfaceMap& map,
            const glm::dvec3& eye_mm,
            const MirrorQuadrature& quadrature,
            const NodeExchange& exchange,
            std::uint32_t* to)
        : mesh_(mesh),
          tracer_(tracer),
          map_(map),
          eye_mm_(eye_mm),
          quadrature_(quadrature),
          exchange_(exchange),
          to_(to) {}

    void begin(std::size_t fragment) {
        fragment_ = static_cast<std::uint32_t>(fragment);
        facets_.emplace(facets_of(mesh_, map_, fragment, eye_mm_, quadrature_));
        ray_origins(mesh_, map_, fragment, origins_);
    }
    /// The set bits of a turn's word.
    void add(std::size_t turn, std::uint64_t word) {
        const std::vector<std::size_t>& traced = quadrature_.traced(turn);
        for (; word != 0; word &= word - 1) {
            const std::size_t k = traced[static_cast<std::size_t>(std::countr_zero(word))];
            TraceRay& ray = rays_.emplace_back();
            ray.origin = origins_[k % origins_.size()];
            ray.direction = (*facets_)[k % facets_->size()].mirrored(k);
            chances_.push_back(static_cast<float>(
                hash_3d(fragment_, static_cast<std::uint32_t>(k), 37u) * 0x1p-32));
        }
        constexpr std::size_t kAtATime = 256;
        if (rays_.size() >= kAtATime) finish();
    }
    /// Those that wait.
    void finish() {
        hits_.resize(rays_.size());
        tracer_.closest(rays_, hits_);
        for (std::size_t k = 0; k < rays_.size(); ++k) {
            *to_++ = ray_at(hits_[k], rays_[k].direction, chances_[k]);
        }
        rays_.clear();
        chances_.clear();
    }

  private:
    /// Of the nodes around, one as often as it weighs.
    std::uint32_t ray_at(const Hit& hit, const glm::vec3& direction, float chance) const {
        // Rounded otherwise than when it was traced
        if (!hit.valid()) return MirrorHits::kInside;
        const bool behind = sees_back(mesh_, hit, direction);
        if (behind && !has_two_sides(mesh_, hit.triangle)) return MirrorHits::kInside;
        const std::uint32_t node =
            exchange_.nodes.around(mesh_, hit.triangle, hit.barycentric, behind, chance);
        const glm::vec3 normal = shading_normal(mesh_, hit);
        return exchange_.ray_toward(node, -direction, behind ? -normal : normal);
    }

    const Mesh& mesh_;
    const Tracer& tracer_;
    const SurfaceMap& map_;
    const glm::dvec3& eye_mm_;
    const MirrorQuadrature& quadrature_;
    const NodeExchange& exchange_;
    std::uint32_t* to_;
    std::optional<Facets> facets_;
    std::array<glm::vec3, kSamplesAFragment> origins_;
    std::uint32_t fragment_ = 0;
    std::vector<TraceRay> rays_;
    std::vector<float> chances_;
    std::vector<Hit> hits_;
};

}  // namespace

MirrorHits find_mirror_hits(const Mesh& mesh,
                            const Tracer& tracer,
                            const SurfaceMap& map,
                            glm::dvec3 eye_mm,
                            const MirrorVisibility& visibility,
                            const NodeExchange& exchange,
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
    hits.rays.resize(hits.first_alone.back());
    const auto rays = [&](std::uint32_t first) {
        return HitRays(
            mesh, tracer, map, eye_mm, visibility.quadrature, exchange, hits.rays.data() + first);
    };
    parallel_for(blocked.size(), 2048, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        HitRays own = rays(hits.first[begin]);
        for (std::size_t i = begin; i < end; ++i) {
            if (blocked[i] == 0) continue;
            own.begin(i);
            own.add(neighbour_turn(map, i), blocked[i]);
        }
        own.finish();
    });
    parallel_for(alone.size(), 256, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        HitRays own = rays(hits.first_alone[begin]);
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t fragment = alone[i].fragment;
            own.begin(fragment);
            for (std::size_t word = 1; word < alone[i].blocked.size(); ++word) {
                own.add((neighbour_turn(map, fragment) + 2 * word) % kNeighbourTurns,
                        alone[i].blocked[word]);
            }
        }
        own.finish();
    });
    return hits;
}

}  // namespace livery
