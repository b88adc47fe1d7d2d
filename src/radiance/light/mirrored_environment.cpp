#include "radiance/light/mirrored_environment.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

MirrorVisibility solve_mirror_visibility(const Mesh& mesh,
                                         const Tracer& tracer,
                                         const SurfaceMap& map,
                                         glm::dvec3 eye_mm,
                                         int nodes,
                                         const Progress& progress) {
    MirrorVisibility result{MirrorQuadrature(mirror_rings(nodes)), {}};
    const MirrorQuadrature& quadrature = result.quadrature;
    result.blocked.assign(map.fragments.size(), 0);
    parallel_for(map.fragments.size(), 512, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        std::vector<TraceRay> rays;
        std::vector<std::size_t> bits;
        std::vector<std::uint8_t> blocked;
        std::array<glm::vec3, kSamplesAFragment> origins;
        for (std::size_t i = begin; i < end; ++i) {
            const Facets facets = facets_of(mesh, map, i, eye_mm, quadrature);
            ray_origins(mesh, map, i, origins);
            rays.clear();
            bits.clear();
            const std::vector<std::size_t>& traced = quadrature.traced(neighbour_turn(map, i));
            for (std::size_t bit = 0; bit < traced.size(); ++bit) {
                const std::size_t k = traced[bit];
                const Facet& facet = facets[k % facets.size()];
                const MirrorQuadrature::Node node = facet.row.node(k);
                if (!any_weight(node)) continue;
                TraceRay& ray = rays.emplace_back();
                ray.origin = origins[k % origins.size()];
                ray.direction = facet.mirrored(node);
                bits.push_back(bit);
            }
            blocked.resize(rays.size());
            tracer.occluded(rays, blocked, RayOrder::scattered);
            for (std::size_t k = 0; k < rays.size(); ++k) {
                if (blocked[k]) result.blocked[i] |= std::uint64_t{1} << bits[k];
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
    neighbours_->around(fragment, scratch.neighbours);
    const std::vector<std::uint64_t>& blocked = visibility_->blocked;
    if (std::all_of(scratch.neighbours.begin(), scratch.neighbours.end(), [&](const auto& one) {
            return blocked[one.fragment] == 0;
        })) {
        return false;
    }
    std::array<float, MirrorQuadrature::kTurns> whole{};
    for (const FragmentNeighbours::Neighbour& one : scratch.neighbours) {
        whole[one.turn] += one.weight;
    }
    const auto is_seen = [&](std::size_t of, std::uint8_t bit) {
        return ((blocked[of] >> bit) & 1u) == 0 ? 1.0f : 0.0f;
    };
    const std::size_t own_turn = neighbour_turn(map_, fragment);
    scratch.seen.assign(quadrature_.count(), 0.0f);
    for (std::size_t k = 0; k < scratch.seen.size(); ++k) {
        const MirrorQuadrature::Ray& ray = quadrature_.ray(k);
        if (ray.turn == MirrorQuadrature::kStraight) {
            scratch.seen[k] = is_seen(fragment, ray.bit);
        } else if (whole[ray.turn] > 0.0f) {
            float sum = 0.0f;
            for (const FragmentNeighbours::Neighbour& one : scratch.neighbours) {
                if (one.turn == ray.turn) sum += one.weight * is_seen(one.fragment, ray.bit);
            }
            scratch.seen[k] = sum / whole[ray.turn];
        } else {
            scratch.seen[k] = is_seen(fragment, quadrature_.nearest(k, own_turn));
        }
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
