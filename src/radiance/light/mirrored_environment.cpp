#include "radiance/light/mirrored_environment.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "radiance/light/light_visibility.h"
#include "radiance/light/sky_visibility.h"
#include "radiance/light/spiral.h"

namespace livery {
namespace {

static_assert(MirrorQuadrature::kFacets == kSamplesAFragment);
static_assert(MirrorQuadrature::kTurns == kNeighbourTurns);

/// The variance that is left to the Gaussian of a node beside hidden ones: a lamp behind an edge of
/// the product must not shine past it.
constexpr float kBesideHidden = 0.4f;

/// One of the normals of a pixel and the nodes around it.
struct Facet {
    glm::vec3 x, y, normal, wo;
    MirrorQuadrature::Row row;
    float variance = 0.0f;  ///< that its own spread of normals adds to its nodes'

    Facet(const Fragment& fragment,
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

    /// Where the eye's direction is mirrored to by a node.
    glm::vec3 mirrored(const MirrorQuadrature::Node& node) const {
        const Texel& v = node.half_vector;
        const glm::vec3 h = v[0] * x + v[1] * y + v[2] * normal;
        return 2.0f * glm::dot(wo, h) / glm::dot(h, h) * h - wo;
    }
};

using Facets = std::array<Facet, kSamplesAFragment>;

/// Every one the fragment's mean.
Facets even_facets(const Fragment& f, const glm::dvec3& eye_mm, const MirrorQuadrature& nodes) {
    const Facet facet(f, f.normal, f.normal_variance, eye_mm, nodes);
    return {facet, facet, facet, facet};
}

/// One a sub-sample, moved together so that their mean is the fragment's: that is a mean over more
/// samples, and goes on more smoothly from pixel to pixel.
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

/// Of `sum`, what grazes of the light of three lobes; without light as of even light.
glm::vec3 grazing_ratio(const std::array<glm::vec3, kMirrorAlphas.size()>& light,
                        const GrazingLobes& lobes,
                        const Texel& sum,
                        const Texel& even) {
    constexpr float kLargest = 8.0f;  // where the term is so small that no one sees it
    glm::vec3 ratio(1.0f);
    for (int k = 0; k < 3; ++k) {
        const glm::vec3& all = light[lobes[static_cast<std::size_t>(k)]];
        const float usual = (all.x + all.y + all.z) * even[k];
        if (usual > 0.0f) ratio[k] = std::clamp(sum[k] / usual, 0.0f, kLargest);
    }
    return ratio;
}

bool any_weight(const MirrorQuadrature::Node& node) {
    // What the widest lobe has nothing of has nothing to give
    return node.weight.back()[3] > 0.0f;
}

/// 1 where the bit is not set: nothing is in the way.
float share_seen(std::uint64_t blocked, std::uint8_t bit) {
    return ((blocked >> bit) & 1u) == 0 ? 1.0f : 0.0f;
}

/// Rays from fragments along the directions that nodes mirror to. For one thread.
class NodeRays {
  public:
    NodeRays(const Mesh& mesh,
             const Tracer& tracer,
             const SurfaceMap& map,
             const glm::dvec3& eye_mm,
             const MirrorQuadrature& quadrature)
        : mesh_(mesh), tracer_(tracer), map_(map), eye_mm_(eye_mm), quadrature_(quadrature) {}

    /// Sets the bits of the nodes of this turn that the product hides.
    void trace(std::size_t fragment, std::size_t turn, std::uint64_t& hidden) {
        const Facets facets = facets_of(mesh_, map_, fragment, eye_mm_, quadrature_);
        ray_origins(mesh_, map_, fragment, origins_);
        const std::vector<std::size_t>& nodes = quadrature_.traced(turn);
        rays_.clear();
        bits_.clear();
        for (std::size_t bit = 0; bit < nodes.size(); ++bit) {
            const std::size_t k = nodes[bit];
            const Facet& facet = facets[k % facets.size()];
            const MirrorQuadrature::Node node = facet.row.node(k);
            if (!any_weight(node)) continue;
            TraceRay& ray = rays_.emplace_back();
            ray.origin = origins_[k % origins_.size()];
            ray.direction = facet.mirrored(node);
            bits_.push_back(bit);
        }
        blocked_.resize(rays_.size());
        tracer_.occluded(rays_, blocked_, RayOrder::scattered);
        for (std::size_t k = 0; k < rays_.size(); ++k) {
            if (blocked_[k]) hidden |= std::uint64_t{1} << bits_[k];
        }
    }

  private:
    const Mesh& mesh_;
    const Tracer& tracer_;
    const SurfaceMap& map_;
    const glm::dvec3& eye_mm_;
    const MirrorQuadrature& quadrature_;
    std::vector<TraceRay> rays_;
    std::vector<std::size_t> bits_;
    std::vector<std::uint8_t> blocked_;
    std::array<glm::vec3, kSamplesAFragment> origins_;
};

/// Fragments that look for themselves, where something is hidden: no neighbour has traced some of
/// the directions, and those traced that come closest are up to a quarter of a ring away; or more
/// than half is hidden, as in a wheel, where a neighbour looks through another gap.
std::vector<std::uint32_t> find_alone(const SurfaceMap& map,
                                      const MirrorQuadrature& quadrature,
                                      std::span<const std::uint64_t> blocked) {
    const FragmentNeighbours neighbours(map);
    std::vector<std::uint8_t> is_alone(map.fragments.size(), 0);
    parallel_for(is_alone.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<FragmentNeighbours::Neighbour> found;
        for (std::size_t i = begin; i < end; ++i) {
            neighbours.around(i, found);
            unsigned turns = 0;
            bool hidden = false;
            for (const FragmentNeighbours::Neighbour& one : found) {
                turns |= 1u << one.turn;
                hidden = hidden || blocked[one.fragment] != 0;
            }
            const auto own = static_cast<std::size_t>(std::popcount(blocked[i]));
            const bool deep = 2 * own > quadrature.traced(neighbour_turn(map, i)).size();
            is_alone[i] = hidden && (turns != (1u << kNeighbourTurns) - 1u || deep);
        }
    });
    std::vector<std::uint32_t> alone;
    for (std::size_t i = 0; i < is_alone.size(); ++i) {
        if (is_alone[i]) alone.push_back(static_cast<std::uint32_t>(i));
    }
    return alone;
}

}  // namespace

MirrorVisibility solve_mirror_visibility(const Mesh& mesh,
                                         const Tracer& tracer,
                                         const SurfaceMap& map,
                                         glm::dvec3 eye_mm,
                                         int nodes,
                                         const Progress& progress) {
    MirrorVisibility result{MirrorQuadrature(mirror_rings(nodes)), {}, {}, {}};
    const MirrorQuadrature& quadrature = result.quadrature;
    result.blocked.assign(map.fragments.size(), 0);
    parallel_for(map.fragments.size(), 512, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        NodeRays rays(mesh, tracer, map, eye_mm, quadrature);
        for (std::size_t i = begin; i < end; ++i) {
            rays.trace(i, neighbour_turn(map, i), result.blocked[i]);
        }
    });

    result.alone = find_alone(map, quadrature, result.blocked);
    result.blocked_alone.resize(result.alone.size());
    parallel_for(result.alone.size(), 64, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        NodeRays rays(mesh, tracer, map, eye_mm, quadrature);
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = result.alone[k], own_turn = neighbour_turn(map, i);
            result.blocked_alone[k][0] = result.blocked[i];
            for (std::size_t word = 1; word < MirrorVisibility::kWordsAlone; ++word) {
                const std::size_t turn = (own_turn + 2 * word) % kNeighbourTurns;
                rays.trace(i, turn, result.blocked_alone[k][word]);
            }
        }
    });
    return result;
}

MirroredEnvironment::MirroredEnvironment(const Environment& environment,
                                         const FilteredEnvironment& filtered,
                                         const Mesh& mesh,
                                         const SurfaceMap& map,
                                         glm::dvec3 eye_mm,
                                         const MirrorVisibility* visibility)
    : scale_(static_cast<float>(environment.scale)),
      places_(environment),
      layers_(filtered),
      mesh_(mesh),
      map_(map),
      eye_mm_(eye_mm),
      visibility_(visibility),
      unoccluded_(visibility ? std::optional<MirrorQuadrature>()
                             : MirrorQuadrature(mirror_rings(0))),
      quadrature_(visibility ? visibility->quadrature : *unoccluded_) {
    if (visibility) neighbours_.emplace(map);
}

bool MirroredEnvironment::find_seen(std::size_t fragment, Scratch& scratch) const {
    const std::vector<std::uint32_t>& alone = visibility_->alone;
    const auto own = std::lower_bound(alone.begin(), alone.end(), fragment);
    if (own != alone.end() && *own == fragment) {
        const auto at = static_cast<std::size_t>(own - alone.begin());
        ask_itself(fragment, visibility_->blocked_alone[at].data(), scratch);
    } else {
        neighbours_->around(fragment, scratch.neighbours);
        if (std::all_of(scratch.neighbours.begin(), scratch.neighbours.end(), [&](const auto& one) {
                return visibility_->blocked[one.fragment] == 0;
            })) {
            return false;
        }
        ask_neighbours(fragment, scratch);
    }
    scratch.width.resize(scratch.seen.size());
    for (std::size_t k = 0; k < scratch.width.size(); ++k) {
        float least = 1.0f;
        for (const std::uint16_t beside : quadrature_.beside(k)) {
            least = std::min(least, scratch.seen[beside]);
        }
        scratch.width[k] = 1.0f - (1.0f - kBesideHidden) * (1.0f - least);
    }
    return true;
}

void MirroredEnvironment::ask_neighbours(std::size_t fragment, Scratch& scratch) const {
    std::array<float, MirrorQuadrature::kTurns> whole{};
    for (const FragmentNeighbours::Neighbour& one : scratch.neighbours) {
        whole[one.turn] += one.weight;
    }
    const std::vector<std::uint64_t>& blocked = visibility_->blocked;
    scratch.seen.assign(quadrature_.count(), 0.0f);
    for (std::size_t k = 0; k < scratch.seen.size(); ++k) {
        const MirrorQuadrature::Ray& ray = quadrature_.ray(k);
        if (ray.turn == MirrorQuadrature::kStraight) {
            scratch.seen[k] = share_seen(blocked[fragment], ray.bit);
            continue;
        }
        float sum = 0.0f;
        for (const FragmentNeighbours::Neighbour& one : scratch.neighbours) {
            if (one.turn == ray.turn) {
                sum += one.weight * share_seen(blocked[one.fragment], ray.bit);
            }
        }
        scratch.seen[k] = sum / whole[ray.turn];
    }
}

void MirroredEnvironment::ask_itself(std::size_t fragment,
                                     const std::uint64_t* words,
                                     Scratch& scratch) const {
    const std::size_t own_turn = neighbour_turn(map_, fragment);
    // How many turns from the fragment's own on
    const auto word_of = [](std::size_t turns) { return turns % kNeighbourTurns / 2; };
    scratch.seen.assign(quadrature_.count(), 0.0f);
    for (std::size_t k = 0; k < scratch.seen.size(); ++k) {
        const MirrorQuadrature::Ray& ray = quadrature_.ray(k);
        if (ray.turn == MirrorQuadrature::kStraight) {
            scratch.seen[k] = share_seen(words[0], ray.bit);
            continue;
        }
        const std::size_t turns = (ray.turn + kNeighbourTurns - own_turn) % kNeighbourTurns;
        if (turns % 2 == 0) {
            scratch.seen[k] = share_seen(words[word_of(turns)], ray.bit);
            continue;
        }
        for (const std::size_t beside : {turns - 1, turns + 1}) {
            const std::size_t turn = (own_turn + beside) % kNeighbourTurns;
            scratch.seen[k] +=
                0.5f * share_seen(words[word_of(beside)], quadrature_.nearest(k, turn));
        }
    }
}

MirroredLight MirroredEnvironment::at_fragment(std::size_t fragment, Scratch& scratch) const {
    const bool hidden = visibility_ && find_seen(fragment, scratch);
    const Facets facets = visibility_ ? facets_of(mesh_, map_, fragment, eye_mm_, quadrature_)
                                      : even_facets(map_.fragments[fragment], eye_mm_, quadrature_);
    // Of each channel, four lobes side by side
    using Sums = std::array<Texel, kMirrorAlphas.size() / 4>;
    Sums red{}, green{}, blue{};
    std::array<Texel, kGrazingLayers> grazing{};
    const auto weight_of = [](const MirrorQuadrature::Node& node, const GrazingLobes& lobes) {
        const auto of = [&](std::size_t lobe) { return node.weight[lobe / 4][lobe % 4]; };
        return Texel{of(lobes[0]), of(lobes[1]), of(lobes[2]), 0.0f};
    };
    for (std::size_t first = 0; first < quadrature_.count(); first += facets.size()) {
        std::array<MirrorQuadrature::Node, kSamplesAFragment> nodes;
        Texel x, y, z;
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            nodes[k] = facets[k].row.node(first + k);
            const glm::vec3 direction = facets[k].mirrored(nodes[k]);
            x[k] = direction.x;
            y[k] = direction.y;
            z[k] = direction.z;
        }
        const SpherePlaces::Four place = places_.of(x, y, z);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            const MirrorQuadrature::Node& node = nodes[k];
            if (!any_weight(node)) continue;
            const float seen = hidden ? scratch.seen[first + k] : 1.0f;
            if (seen <= 0.0f) continue;
            const float width = hidden ? scratch.width[first + k] : 1.0f;
            const float variance = width * node.half_vector[3] + facets[k].variance;
            const Texel light =
                Texel{seen, seen, seen, seen} * layers_.at({place.u[k], place.v[k]}, variance);
            for (std::size_t i = 0; i < node.weight.size(); ++i) {
                const Texel& w = node.weight[i];
                red[i] += w * light[0];
                green[i] += w * light[1];
                blue[i] += w * light[2];
            }
            const float all = light[0] + light[1] + light[2];
            const float half = all * node.grazing[0], incident = all * node.grazing[1];
            for (std::size_t i = 0; i < kHalfAngleLobes.size(); ++i) {
                grazing[i] += Texel{half, half, half, 0.0f} * weight_of(node, kHalfAngleLobes[i]);
            }
            grazing.back() +=
                Texel{incident, incident, incident, 0.0f} * weight_of(node, kEntryLobes);
        }
    }
    MirroredLight result;
    for (std::size_t lobe = 0; lobe < result.lobe.size(); ++lobe) {
        const std::size_t i = lobe / 4, k = lobe % 4;
        result.lobe[lobe] = glm::vec3(red[i][k], green[i][k], blue[i][k]);
    }
    const Fragment& mean = map_.fragments[fragment];
    const glm::vec3 wo = toward_eye(mean, eye_mm_);
    const float cosine = std::clamp(glm::dot(wo, mean.normal), 0.0f, 1.0f);
    const MirrorQuadrature::Even even =
        quadrature_.seen_under(std::sqrt(1.0f - cosine * cosine)).even();
    for (std::size_t i = 0; i < grazing.size(); ++i) {
        const GrazingLobes& lobes = i < kHalfAngleLobes.size() ? kHalfAngleLobes[i] : kEntryLobes;
        result.grazing[i] = grazing_ratio(result.lobe, lobes, grazing[i], even.of[i]);
    }
    for (glm::vec3& light : result.lobe) light *= scale_;
    return result;
}

}  // namespace livery
