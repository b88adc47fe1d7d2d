#include "radiance/mirror_quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

constexpr double kPi = std::numbers::pi;

/// Slopes of the innermost ring, half of the sharpest layer's width, and of the last, past which
/// even alpha 1 has 3% of its normals, nearly all of them masked.
constexpr double kFirstRing = 0.007, kLastRing = 6.0;
/// Rays within this slope of the mirror direction, 3 degrees of the reflection, say the same.
constexpr double kStraightSlope = 0.03;
/// Gaussians as wide as a cell's own variance would leave gaps between the nodes.
constexpr double kOverlap = 1.4;

/// Rows of the table, even in the root of 1 - sine: that is linear in the cosine at grazing and in
/// the sine at the normal, and so is what changes there.
constexpr std::size_t kRows = 128;
constexpr double kLowestCosine = 1e-4;

/// Masking and shadowing, with all that turns slopes of half vectors into light from there:
/// f cos dwi = P22 dslope x this. `wo` and `wi` around `h`, its z component that of unit length.
double masking(const glm::dvec3& h, const glm::dvec3& wi, const glm::dvec3& wo, double alpha) {
    const auto slope_length = [&](double mu) {
        return std::sqrt(alpha * alpha + (1.0 - alpha * alpha) * mu * mu);
    };
    const double g2 = 2.0 * wi.z * wo.z / (wi.z * slope_length(wo.z) + wo.z * slope_length(wi.z));
    return g2 * glm::dot(wo, h) / (h.z * wo.z);
}

/// A node around the slope (x, y) that stands for `area` of the slopes; weights not yet normalised.
MirrorQuadrature::Node node_at(double x, double y, double area, const glm::dvec3& wo) {
    MirrorQuadrature::Node node{};
    const glm::dvec3 h = glm::normalize(glm::dvec3(x, y, 1.0));
    const double cosine = glm::dot(wo, h);
    const glm::dvec3 wi = 2.0 * cosine * h - wo;
    const double solid_angle = area * 4.0 * std::max(cosine, 1e-4) * h.z * h.z * h.z;
    node.half_vector = Texel{static_cast<float>(h.x),
                             static_cast<float>(h.y),
                             static_cast<float>(h.z),
                             static_cast<float>(kOverlap * kOverlap * solid_angle / (4.0 * kPi))};
    if (cosine <= 0.0 || wi.z <= 0.0) return node;
    for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
        const double a2 = std::pow(static_cast<double>(kMirrorAlphas[k]), 2.0);
        const double spread = 1.0 + (x * x + y * y) / a2;
        node.weight[k / 4][k % 4] = static_cast<float>(area / (kPi * a2 * spread * spread) *
                                                       masking(h, wi, wo, std::sqrt(a2)));
    }
    return node;
}

std::size_t rings_of(const MirrorRings& size) {
    return static_cast<std::size_t>(std::ceil(std::log(kLastRing / kFirstRing) / size.step));
}

double slope_of(const MirrorRings& size, std::size_t ring) {
    return kFirstRing * std::exp(size.step * static_cast<double>(ring));
}

std::vector<MirrorQuadrature::Node> nodes_under(double mu, const MirrorRings& size) {
    const glm::dvec3 wo(std::sqrt(1.0 - mu * mu), 0.0, mu);
    // Mirrored, slopes along the eye's plane move light 1 / mu times as far as those across it.
    // Half way between slopes and directions, cells are stretched by little in either.
    const double across = std::pow(std::max(mu, 0.02), -0.4);
    std::vector<MirrorQuadrature::Node> nodes;
    const double inner = kFirstRing * std::exp(-0.5 * size.step);
    for (std::size_t k = 0; k < MirrorQuadrature::kFacets; ++k) {
        nodes.push_back(node_at(0.0, 0.0, kPi * inner * inner * across, wo));
        for (Texel& w : nodes.back().weight) w *= 1.0f / MirrorQuadrature::kFacets;
    }
    const double turn = 2.0 * kPi / size.nodes;
    for (std::size_t ring = 0; ring < rings_of(size); ++ring) {
        const double slope = slope_of(size, ring);
        const double area = slope * slope * std::sinh(size.step) * turn * across;
        for (int k = 0; k < size.nodes; ++k) {
            const double phi = turn * (k + (ring % 2 == 1 ? 0.5 : 0.0));
            nodes.push_back(
                node_at(slope * std::cos(phi), slope * std::sin(phi) * across, area, wo));
        }
    }
    std::array<Texel, kMirrorAlphas.size() / 4> whole{};
    for (const MirrorQuadrature::Node& node : nodes) {
        for (std::size_t i = 0; i < whole.size(); ++i) whole[i] += node.weight[i];
    }
    for (MirrorQuadrature::Node& node : nodes) {
        for (std::size_t i = 0; i < whole.size(); ++i) node.weight[i] /= whole[i];
    }
    return nodes;
}

}  // namespace

MirrorRings mirror_rings(int nodes) {
    if (nodes == 0) return {4, 0.8};
    return {nodes, 2.0 * kPi / nodes};
}

int mirror_nodes(int nodes) {
    const MirrorRings size = mirror_rings(nodes);
    return static_cast<int>(MirrorQuadrature::kFacets +
                            rings_of(size) * static_cast<std::size_t>(size.nodes));
}

int mirror_rays(int nodes) {
    if (nodes == 0) return 0;
    const MirrorRings size = mirror_rings(nodes);
    std::size_t straight = 0;
    while (slope_of(size, straight) < kStraightSlope) ++straight;
    const std::size_t all = (rings_of(size) - straight) * static_cast<std::size_t>(nodes);
    return static_cast<int>(MirrorQuadrature::kFacets + all / MirrorQuadrature::kTurns);
}

MirrorQuadrature::MirrorQuadrature(const MirrorRings& size) : nodes_(size.nodes) {
    check_argument(size.nodes > 0 && size.nodes % static_cast<int>(kFacets) == 0 && size.step > 0.1,
                   fmt::format("rings of {} nodes, {} apart", size.nodes, size.step));
    count_ = kFacets + rings_of(size) * static_cast<std::size_t>(size.nodes);
    rows_.resize((kRows + 1) * count_);
    parallel_for(kRows + 1, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            const double root = static_cast<double>(row) / kRows;
            const double sine = 1.0 - root * root;
            const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
            const auto nodes = nodes_under(std::max(cosine, kLowestCosine), size);
            std::copy(nodes.begin(),
                      nodes.end(),
                      rows_.begin() + static_cast<std::ptrdiff_t>(row * count_));
        }
    });
    share_out_rays(rings_of(size), size);
}

void MirrorQuadrature::share_out_rays(std::size_t rings, const MirrorRings& size) {
    const auto nodes = static_cast<std::size_t>(size.nodes);
    rays_.resize(count_);
    nearest_.resize(count_);
    for (std::size_t k = 0; k < kFacets; ++k) {
        rays_[k].bit = static_cast<std::uint8_t>(k);
        for (auto& traced : traced_) traced.push_back(k);
    }
    for (std::size_t ring = 0; ring < rings; ++ring) {
        const std::size_t first = kFacets + ring * nodes;
        const double slope = slope_of(size, ring);
        for (std::size_t k = 0; k < nodes; ++k) {
            Ray& ray = rays_[first + k];
            if (slope < kStraightSlope) {
                ray.bit = static_cast<std::uint8_t>((first + k) % kFacets);
                continue;
            }
            // Of each facet, too, every turn gets some
            const std::size_t turn = (k + k / kTurns + ring) % kTurns;
            ray = {static_cast<std::uint8_t>(turn),
                   static_cast<std::uint8_t>(traced_[turn].size())};
            traced_[turn].push_back(first + k);
        }
        for (std::size_t k = 0; k < nodes; ++k) {
            for (std::size_t turn = 0; turn < kTurns; ++turn) {
                std::size_t closest = 2 * nodes;
                for (std::size_t j = 0; j < nodes; ++j) {
                    const Ray& ray = rays_[first + j];
                    const std::size_t apart =
                        std::min((j + nodes - k) % nodes, (k + nodes - j) % nodes);
                    if (ray.turn != turn || apart >= closest) continue;
                    closest = apart;
                    nearest_[first + k][turn] = ray.bit;
                }
            }
        }
    }
    for (const auto& traced : traced_) {
        check_argument(traced.size() <= 64,
                       fmt::format("rings of {} nodes, {} apart", size.nodes, size.step));
    }
}

MirrorQuadrature::Row MirrorQuadrature::seen_under(float sine) const {
    const float at = std::sqrt(std::clamp(1.0f - sine, 0.0f, 1.0f)) * static_cast<float>(kRows);
    const std::size_t below = std::min(static_cast<std::size_t>(at), kRows - 1);
    Row row;
    row.below_ = &rows_[below * count_];
    row.above_ = row.below_ + count_;
    row.share_ = at - static_cast<float>(below);
    return row;
}

}  // namespace livery
