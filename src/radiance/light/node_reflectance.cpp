#include "radiance/light/node_reflectance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "appearance/paint_bsdf.h"
#include "appearance/parameter_table.h"
#include "core/parallel.h"
#include "radiance/light/sphere_lookup.h"
#include "scene/artwork_coats.h"

namespace livery {

namespace {

constexpr float kBrightLobe = 0.1f;

std::vector<glm::vec3> cosine_directions(std::size_t count) {
    std::vector<glm::vec3> directions;
    for (std::size_t k = 0; k < count; ++k) {
        const auto n = static_cast<double>(k);
        const double u = (n + 0.5) / static_cast<double>(count), angle = kGoldenAngle_rad * n;
        directions.emplace_back(
            std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle), std::sqrt(1.0 - u));
    }
    return directions;
}

float brightest(const glm::vec3& v) { return std::max({v.x, v.y, v.z}); }

/// What comes along one ray, taken for coming along those around it as well: where a lobe is
/// narrower than rays are apart, one of them alone would stand for all that it sees.
class Spread {
  public:
    explicit Spread(std::span<const glm::vec3> rays)
        : count_(rays.size()), shares_(count_ * count_) {
        for (std::size_t from = 0; from < count_; ++from) {
            float* shares = &shares_[from * count_];
            float sum = 0.0f;
            for (std::size_t to = 0; to < count_; ++to) {
                sum += shares[to] = share_of_ray(rays[to] - rays[from], count_);
            }
            for (std::size_t to = 0; to < count_; ++to) shares[to] /= sum;
        }
    }
    std::vector<glm::vec3> applied(const std::vector<glm::vec3>& row) const {
        std::vector<glm::vec3> spread(count_, glm::vec3(0.0f));
        for (std::size_t from = 0; from < count_; ++from) {
            for (std::size_t to = 0; to < count_; ++to) {
                spread[to] += shares_[from * count_ + to] * row[from];
            }
        }
        return spread;
    }

  private:
    std::size_t count_;
    std::vector<float> shares_;
};

glm::vec3 lobes_at(const PaintBsdf& bsdf, float cosine) {
    const f32::BsdfEnvironment weights = environment_weights(bsdf, cosine);
    return weights.specular + weights.coat;
}

}  // namespace

NodeDirections::NodeDirections(int count)
    : directions_(cosine_directions(static_cast<std::size_t>(count))) {
    for (int row = 0; row < kColumns; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const float x = (2.0f * static_cast<float>(column) + 1.0f) / kColumns - 1.0f;
            const float y = (2.0f * static_cast<float>(row) + 1.0f) / kColumns - 1.0f;
            const auto distance2 = [&](const glm::vec3& d) {
                return (d.x - x) * (d.x - x) + (d.y - y) * (d.y - y);
            };
            const auto found = std::min_element(
                directions_.begin(), directions_.end(), [&](const auto& a, const auto& b) {
                    return distance2(a) < distance2(b);
                });
            nearest_[static_cast<std::size_t>(row * kColumns + column)] =
                static_cast<std::uint8_t>(found - directions_.begin());
        }
    }
}

std::uint8_t NodeDirections::nearest(const glm::vec3& direction) const {
    glm::vec3 at = direction;
    if (at.z < 0.0f) {
        at.z = 0.0f;
        at /= std::max(glm::length(at), 1e-6f);
    }
    const auto place = [](float v) {
        return std::clamp(static_cast<int>((v + 1.0f) * (0.5f * kColumns)), 0, kColumns - 1);
    };
    return nearest_[static_cast<std::size_t>(place(at.y) * kColumns + place(at.x))];
}

NodeLight dark_nodes(const ExchangeNodes& nodes, const std::vector<bool>& parts, std::size_t rays) {
    NodeLight light;
    light.first.reserve(nodes.size() + 1);
    light.first.push_back(0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::size_t own = parts[nodes.part(i)] ? rays : 1;
        light.first.push_back(light.first.back() + static_cast<std::uint32_t>(own));
    }
    light.values.assign(light.first.back(), glm::vec3(0.0f));
    return light;
}

RayMatrix::RayMatrix(const Material& paint, const NodeDirections& rays)
    : count_(rays.count()),
      stride_((count_ + kBlock - 1) / kBlock * kBlock),
      shares_(3 * count_ * stride_, 0.0f) {
    // Of each kind, weighted by what both together are as dense as (Veach's balance heuristic)
    constexpr std::size_t kSamples = 512;
    const PaintBsdf bsdf = bsdf_of(paint);
    const std::vector<glm::vec3> even = cosine_directions(kSamples);
    const Spread spread(rays.directions());
    constexpr auto kPi = std::numbers::pi_v<float>;
    parallel_for(count_, 4, [&](std::size_t begin, std::size_t end) {
        std::vector<glm::vec3> row(count_);
        for (std::size_t to = begin; to < end; ++to) {
            const glm::vec3 wo = rays.directions()[to];
            std::fill(row.begin(), row.end(), glm::vec3(0.0f));
            const auto add = [&](const glm::vec3& wi) {
                if (!(wi.z > 0.0f)) return;
                const float density = pdf(bsdf, wi, wo) + wi.z / kPi;
                row[rays.nearest(wi)] += wi.z / density * evaluate(bsdf, wi, wo);
            };
            for (std::size_t k = 0; k < kSamples; ++k) {
                add(even[k]);
                // Roberts' sequence
                constexpr double kStep[] = {
                    0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
                glm::vec3 u;
                for (int c = 0; c < 3; ++c) {
                    const double at = 0.5 + kStep[c] * static_cast<double>(k + 1);
                    u[c] = std::min(static_cast<float>(at - std::floor(at)), 0.9999999f);
                }
                add(sample(bsdf, wo, u));
            }
            row = spread.applied(row);
            glm::vec3 sum(0.0f);
            for (const glm::vec3& share : row) sum += share;
            const f32::BsdfEnvironment weights = environment_weights(bsdf, wo.z);
            const glm::vec3 albedo =
                glm::min(weights.diffuse + weights.specular + weights.coat, glm::vec3(1.0f));
            for (std::size_t from = 0; from < count_; ++from) {
                for (int c = 0; c < 3; ++c) {
                    const float share = sum[c] > 0.0f ? row[from][c] * albedo[c] / sum[c] : 0.0f;
                    shares_[(static_cast<std::size_t>(c) * count_ + from) * stride_ + to] = share;
                }
            }
        }
    });
}

void RayMatrix::send(std::span<const glm::vec3> comes, std::span<glm::vec3> sent) const {
    for (int c = 0; c < 3; ++c) {
        alignas(32) std::array<float, kMostNodeRays> sums{};
        const float* row = shares_.data() + static_cast<std::size_t>(c) * count_ * stride_;
        for (std::size_t from = 0; from < count_; ++from, row += stride_) {
            const float light = comes[from][c];
            if (light == 0.0f) continue;
            for (std::size_t block = 0; block < stride_; block += kBlock) {
                for (std::size_t k = 0; k < kBlock; ++k) {
                    sums[block + k] += light * row[block + k];
                }
            }
        }
        for (std::size_t to = 0; to < count_; ++to) sent[to][c] = sums[to];
    }
}

void NodeReflectance::send(const ExchangeNodes& nodes,
                           std::size_t node,
                           const glm::vec3& mean,
                           std::span<const glm::vec3> comes,
                           std::span<glm::vec3> sent) const {
    const glm::vec3 even = evenly[node] * mean;
    const std::size_t part = nodes.part(node);
    if (!lobes[part]) {
        sent[0] = even;
        return;
    }
    matrices[of_part[part]].send(comes, sent);
    for (glm::vec3& light : sent) light = by_lobes[node] * light + even;
}

std::vector<bool> parts_with_lobes(const Scene& scene) {
    std::vector<bool> lobes;
    for (const Material& material : scene.part_materials) {
        lobes.push_back(brightest(lobes_at(bsdf_of(material), 0.5f)) > kBrightLobe);
    }
    return lobes;
}

NodeReflectance reflectance_at_nodes(const Scene& scene,
                                     const ExchangeNodes& nodes,
                                     const NodeDirections& rays) {
    NodeReflectance made;
    made.lobes = parts_with_lobes(scene);
    const std::vector<Material>& paints = scene.part_materials;
    std::vector<glm::vec3> albedo;
    made.of_part.resize(paints.size());
    for (std::size_t p = 0; p < paints.size(); ++p) {
        albedo.push_back(hemispherical_albedo(bsdf_of(paints[p])));
        if (!made.lobes[p]) continue;
        std::size_t same = 0;
        while (same < p && !(made.lobes[same] && same_reflectance(paints[same], paints[p]))) ++same;
        made.of_part[p] = same < p ? made.of_part[same] : made.matrices.size();
        if (same == p) made.matrices.emplace_back(paints[p], rays);
    }
    made.by_lobes.assign(nodes.size(), 1.0f);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::size_t part = nodes.part(i);
        made.albedo.push_back(albedo[part]);
        made.evenly.push_back(made.lobes[part] ? glm::vec3(0.0f) : albedo[part]);
    }
    for (const PartArtwork& artwork : scene.artwork) {
        // Pictures are taken for their paint's own colour: of a decal the mean matters little
        const glm::vec3 over = hemispherical_albedo(bsdf_of(artwork.material));
        parallel_for(nodes.size(), 2048, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (nodes.part(i) != artwork.part) continue;
                const ArtworkPoint at = artwork_at(artwork,
                                                   glm::dvec3(nodes.position_mm(i)),
                                                   glm::dvec3(nodes.normal(i)),
                                                   glm::dvec2(nodes.points.uvs[nodes.point_of[i]]));
                const auto cover = static_cast<float>(at.cover);
                made.albedo[i] = glm::mix(made.albedo[i], over, cover);
                made.evenly[i] = glm::mix(made.evenly[i], over, cover);
                made.by_lobes[i] *= 1.0f - cover;
            }
        });
    }
    return made;
}

}  // namespace livery
