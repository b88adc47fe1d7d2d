#include <algorithm>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "mesh/gltf/gltf_parts.h"

namespace livery {

namespace {

glm::dmat4 local_transform(const GltfFile& gltf, std::size_t index) {
    const tinygltf::Node& node = gltf.model.nodes[index];
    const std::string field = fmt::format("nodes[{}]", index);
    if (const auto& m = node.matrix; !m.empty()) {
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            gltf.fail(field + ".matrix", "a projective matrix", "0, 0, 0, 1 as its last row");
        }
        return glm::make_mat4(m.data());
    }
    glm::dmat4 matrix(1.0);
    if (const auto& q = node.rotation; !q.empty()) {
        const glm::dquat rotation(q[3], q[0], q[1], q[2]);
        if (!(glm::length(rotation) > 1e-6)) {
            const auto said = gltf.root()["nodes"].at(index)["rotation"];
            said.fail(said.found(), "a unit quaternion");
        }
        matrix = glm::mat4_cast(glm::normalize(rotation));
    }
    for (std::size_t k = 0; k < node.scale.size(); ++k) {
        matrix[static_cast<int>(k)] *= node.scale[k];
    }
    if (const auto& t = node.translation; !t.empty()) {
        matrix[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
    }
    return matrix;
}

bool is_hidden(const tinygltf::Node& node) {
    const auto visibility = node.extensions.find("KHR_node_visibility");
    return visibility != node.extensions.end() && visibility->second.Has("visible") &&
           !visibility->second.Get("visible").Get<bool>();
}

}  // namespace

std::vector<PlacedNode> placed_nodes(const GltfFile& gltf, std::vector<std::string>& notes) {
    const tinygltf::Model& model = gltf.model;
    std::vector<PlacedNode> pending;  // last in, first out: the order of the file is reversed
    const auto put = [&](const std::vector<int>& nodes, const glm::dmat4& world_from_parent) {
        for (std::size_t k = nodes.size(); k-- > 0;) {
            pending.push_back({static_cast<std::size_t>(nodes[k]), world_from_parent});
        }
    };
    if (!model.scenes.empty()) {
        put(model.scenes[static_cast<std::size_t>(std::max(model.defaultScene, 0))].nodes,
            glm::dmat4(1.0));
    } else {
        // Without scenes: every node that is nobody's child.
        std::vector<bool> is_child(model.nodes.size(), false);
        for (const auto& node : model.nodes) {
            for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
        }
        std::vector<int> roots;
        for (std::size_t n = 0; n < model.nodes.size(); ++n) {
            if (!is_child[n]) roots.push_back(static_cast<int>(n));
        }
        put(roots, glm::dmat4(1.0));
    }

    std::vector<PlacedNode> placed;
    std::vector<bool> seen(model.nodes.size(), false);
    while (!pending.empty()) {
        PlacedNode next = pending.back();
        pending.pop_back();
        const tinygltf::Node& node = model.nodes[next.index];
        if (seen[next.index]) {
            gltf.fail(fmt::format("nodes[{}]", next.index),
                      "a node reached twice (a cycle, or two parents)",
                      "a tree");
        }
        seen[next.index] = true;
        if (is_hidden(node)) {
            notes.push_back(fmt::format("nodes[{}] is not visible; dropped", next.index));
            continue;
        }
        next.world_from_node = next.world_from_node * local_transform(gltf, next.index);
        placed.push_back(next);
        put(node.children, next.world_from_node);
    }
    return placed;
}

}  // namespace livery
