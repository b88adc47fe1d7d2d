// How paints send light on at nodes: a diffuser evenly, a paint with lobes from each of a node's
// rays into each (Immel, Cohen, Greenberg 1986).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "radiance/light/exchange_nodes.h"
#include "scene/scene.h"

namespace livery {

/// Rays of a node, 64 at most.
inline constexpr int kMostNodeRays = 64;

/// So many cosine-weighted directions around +z, which nodes turn to their own normals. They also
/// tell apart where a node sends light to.
class NodeDirections {
  public:
    NodeDirections() = default;
    explicit NodeDirections(int count);

    std::span<const glm::vec3> directions() const { return directions_; }
    std::size_t count() const { return directions_.size(); }
    /// The one that is nearest to a direction, or to where it meets the horizon.
    std::uint8_t nearest(const glm::vec3& direction) const;

  private:
    static constexpr int kColumns = 64;  ///< of the disc under the hemisphere, and as many rows

    std::vector<glm::vec3> directions_;
    std::array<std::uint8_t, kColumns * kColumns> nearest_{};
};

/// What a ray takes of light that comes from so far beside it, not normalised: that of rays up to
/// half as far again away as two are apart at the pole.
inline float share_of_ray(const glm::vec3& apart, std::size_t rays) {
    const float near =
        std::max(0.0f, 1.0f - glm::dot(apart, apart) * static_cast<float>(rays) / 9.0f);
    return near * near;
}

/// One of a node's rays, or what it sends along it.
inline std::uint32_t ray_of_node(std::uint32_t node, std::uint8_t ray) {
    return node * static_cast<std::uint32_t>(kMostNodeRays) + ray;
}

/// Of each node one value, or where its paint has lobes one a ray.
struct NodeLight {
    std::vector<std::uint32_t> first;  ///< of each node, and past the last
    std::vector<glm::vec3> values;

    bool empty() const { return values.empty(); }
    bool by_ray(std::size_t node) const { return first[node + 1] - first[node] > 1; }
    std::span<glm::vec3> of(std::size_t node) {
        return std::span(values).subspan(first[node], first[node + 1] - first[node]);
    }
    std::span<const glm::vec3> of(std::size_t node) const {
        return std::span(values).subspan(first[node], first[node + 1] - first[node]);
    }
    /// What ray_of_node() names.
    const glm::vec3& along(std::uint32_t ray) const {
        const std::uint32_t node = ray / kMostNodeRays;
        return values[first[node] + (by_ray(node) ? ray % kMostNodeRays : 0)];
    }
};
/// Black, one a ray for nodes of these parts.
NodeLight dark_nodes(const ExchangeNodes& nodes, const std::vector<bool>& parts, std::size_t rays);

/// What a paint sends along each ray of what comes along each. Rows sum to its directional albedo.
class RayMatrix {
  public:
    RayMatrix(const Material& paint, const NodeDirections& rays);
    void send(std::span<const glm::vec3> comes, std::span<glm::vec3> sent) const;

  private:
    static constexpr std::size_t kBlock = 8;  ///< of rays that are summed together
    std::size_t count_ = 0, stride_ = 0;
    std::vector<float> shares_;  ///< by channel, ray that comes and ray that is sent
};

struct NodeReflectance {
    std::vector<bool> lobes;           ///< parts that send light by their lobes
    std::vector<RayMatrix> matrices;   ///< of those paints
    std::vector<std::size_t> of_part;  ///< which of them
    std::vector<glm::vec3> albedo;     ///< hemispherical, of each node: under artwork that of both
    std::vector<glm::vec3> evenly;     ///< what of it a node sends as a diffuser does
    std::vector<float> by_lobes;       ///< of each node, the share of the part's own paint

    /// `mean` is of what comes from all around, `comes` of each ray where the node's part has
    /// lobes.
    void send(const ExchangeNodes& nodes,
              std::size_t node,
              const glm::vec3& mean,
              std::span<const glm::vec3> comes,
              std::span<glm::vec3> sent) const;
};
/// Parts whose paints return more than a tenth in lobes; what less shines is as good as a diffuser.
std::vector<bool> parts_with_lobes(const Scene& scene);
NodeReflectance reflectance_at_nodes(const Scene& scene,
                                     const ExchangeNodes& nodes,
                                     const NodeDirections& rays);

}  // namespace livery
