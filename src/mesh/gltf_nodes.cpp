#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "mesh/gltf_parts.h"

namespace livery {

namespace {

glm::dmat4 local_transform(const JsonReader& node) {
    if (node.has("matrix")) {
        const auto m = node["matrix"].numbers(16);
        glm::dmat4 matrix;
        for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] = m[static_cast<std::size_t>(k)];
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            node["matrix"].fail("a projective matrix", "0, 0, 0, 1 as its last row");
        }
        return matrix;
    }
    glm::dmat4 matrix(1.0);
    if (node.has("rotation")) {
        const auto q = node["rotation"].numbers(4);
        const glm::dquat rotation(q[3], q[0], q[1], q[2]);
        if (!(glm::length(rotation) > 1e-6)) {
            node["rotation"].fail(node["rotation"].found(), "a unit quaternion");
        }
        matrix = glm::mat4_cast(glm::normalize(rotation));
    }
    if (node.has("scale")) {
        const glm::dvec3 scale = node["scale"].vec3();
        for (int k = 0; k < 3; ++k) matrix[k] *= scale[k];
    }
    if (node.has("translation")) matrix[3] = glm::dvec4(node["translation"].vec3(), 1.0);
    return matrix;
}

}  // namespace

std::vector<PlacedNode> placed_nodes(const JsonReader& root) {
    const std::size_t count = root.has("nodes") ? root["nodes"].size() : 0;
    std::vector<PlacedNode> pending;  // last in, first out: the order of the file is reversed
    if (root.has("scenes") && root["scenes"].size() > 0) {
        const std::size_t shown = root.has("scene") ? index_into(root, "scenes", root["scene"]) : 0;
        const auto scene = root["scenes"].at(shown);
        const std::size_t roots = scene.has("nodes") ? scene["nodes"].size() : 0;
        for (std::size_t k = roots; k-- > 0;) {
            pending.push_back({index_into(root, "nodes", scene["nodes"].at(k)), glm::dmat4(1.0)});
        }
    } else {
        // Without scenes: every node that is nobody's child.
        std::vector<bool> is_child(count, false);
        for (std::size_t n = 0; n < count; ++n) {
            const auto node = root["nodes"].at(n);
            for (std::size_t c = 0; node.has("children") && c < node["children"].size(); ++c) {
                is_child[index_into(root, "nodes", node["children"].at(c))] = true;
            }
        }
        for (std::size_t n = count; n-- > 0;) {
            if (!is_child[n]) pending.push_back({n, glm::dmat4(1.0)});
        }
    }

    std::vector<PlacedNode> placed;
    std::vector<bool> seen(count, false);
    while (!pending.empty()) {
        PlacedNode next = pending.back();
        pending.pop_back();
        const auto node = root["nodes"].at(next.index);
        if (seen[next.index]) node.fail("a node reached twice (a cycle, or two parents)", "a tree");
        seen[next.index] = true;
        next.world_from_node = next.world_from_node * local_transform(node);
        placed.push_back(next);
        if (!node.has("children")) continue;
        for (std::size_t c = node["children"].size(); c-- > 0;) {
            const std::size_t child = index_into(root, "nodes", node["children"].at(c));
            pending.push_back({child, next.world_from_node});
        }
    }
    return placed;
}

}  // namespace livery
