#include "radiance/light/mirror_visibility.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "core/random.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/sky_visibility.h"
#include "radiance/light/sphere_lookup.h"
#include "radiance/smooth_runs.h"

namespace livery {

Facet::Facet(const Fragment& fragment,
             const glm::vec3& its_normal,
             float slope_variance,
             const glm::dvec3& eye_mm,
             const MirrorQuadrature& quadrature)
    : normal(its_normal) {
    Fragment part;
    part.position_mm = fragment.position_mm;
    part.normal = normal;
    wo = toward_eye(part, eye_mm);
    const float mu = glm::dot(wo, normal);
    const glm::vec3 along = wo - mu * normal;
    const float length = glm::length(along);
    x = length > 1e-5f ? along / length : basis_around(normal).s;
    y = glm::cross(normal, x);
    row = quadrature.seen_under(length);
    // Half of the mean squared slope along each axis; mirrored, twice that angle in the eye's
    // plane, and 2 mu times across it
    variance = 2.0f * mu * slope_variance;
}

glm::vec3 Facet::mirrored(std::size_t node) const {
    const glm::vec3 v = row.half_vector(node);
    const glm::vec3 h = v.x * x + v.y * y + v.z * normal;
    return 2.0f * glm::dot(wo, h) / glm::dot(h, h) * h - wo;
}

Facets even_facets(const Fragment& f, const glm::dvec3& eye_mm, const MirrorQuadrature& nodes) {
    const Facet facet(f, f.normal, f.normal_variance, eye_mm, nodes);
    return {facet, facet, facet, facet};
}

Facets facets_of(const Mesh& mesh,
                 const SurfaceMap& map,
                 std::size_t index,
                 const glm::dvec3& eye_mm,
                 const MirrorQuadrature& nodes) {
    const Fragment& f = map.fragments[index];
    std::array<glm::vec3, kSamplesAFragment> normal;
    glm::vec3 away = f.normal;
    for (std::size_t k = 0; k < normal.size(); ++k) {
        normal[k] = sample_normal(mesh, map, index, k);
        away -= normal[k] / static_cast<float>(normal.size());
    }
    const auto facet = [&](std::size_t k) {
        // Four quarters of a pixel each keep a quarter of its spread
        return Facet(f,
                     glm::normalize(normal[k] + away),
                     f.normal_variance / static_cast<float>(normal.size()),
                     eye_mm,
                     nodes);
    };
    return {facet(0), facet(1), facet(2), facet(3)};
}

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
