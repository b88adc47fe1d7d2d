#include "posts.h"

#include <cstddef>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace livery::assets {

namespace {

constexpr auto kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) {
    return (static_cast<std::uint64_t>(from) << 32) | to;
}

/// Corners (3 * triangle + k) that belong together.
struct Unions {
    std::vector<std::uint32_t> parent;
    explicit Unions(std::size_t count) : parent(count) {
        std::iota(parent.begin(), parent.end(), 0u);
    }
    std::uint32_t find(std::uint32_t k) {
        while (parent[k] != k) k = parent[k] = parent[parent[k]];
        return k;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent[find(a)] = find(b); }
};

}  // namespace

Posts stand_posts(const Sheet& sheet, const std::vector<int>& piece_of_triangle) {
    const auto count = static_cast<std::uint32_t>(sheet.triangles.size());
    std::unordered_map<std::uint64_t, std::uint32_t> half_edges;  // -> 3 * triangle + k
    for (std::uint32_t t = 0; t < count; ++t) {
        const auto& c = sheet.triangles[t].corners;
        for (std::uint32_t k = 0; k < 3; ++k) {
            half_edges[edge_key(c[static_cast<int>(k)], c[static_cast<int>((k + 1) % 3)])] =
                3 * t + k;
        }
    }
    const auto twin_of = [&](std::uint32_t t, std::uint32_t k) {
        const auto& c = sheet.triangles[t].corners;
        const auto found =
            half_edges.find(edge_key(c[static_cast<int>((k + 1) % 3)], c[static_cast<int>(k)]));
        return found == half_edges.end() ? kNone : found->second;
    };

    Unions corners(3 * sheet.triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const auto twin = twin_of(t, k);
            if (twin == kNone || piece_of_triangle[twin / 3] != piece_of_triangle[t]) continue;
            // The twin runs the other way.
            corners.join(3 * t + k, 3 * (twin / 3) + (twin % 3 + 1) % 3);
            corners.join(3 * t + (k + 1) % 3, twin);
        }
    }

    Posts posts;
    posts.of_triangle.assign(count, glm::uvec3(kNone));
    std::vector<std::uint32_t> post_of_root(3 * sheet.triangles.size(), kNone);
    for (std::uint32_t t = 0; t < count; ++t) {
        if (piece_of_triangle[t] == kNoPanel) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            auto& post = post_of_root[corners.find(3 * t + k)];
            if (post == kNone) {
                post = static_cast<std::uint32_t>(posts.vertex.size());
                posts.vertex.push_back(sheet.triangles[t].corners[static_cast<int>(k)]);
                posts.piece.push_back(piece_of_triangle[t]);
            }
            posts.of_triangle[t][static_cast<int>(k)] = post;
        }
    }
    posts.on_centre.assign(posts.vertex.size(), false);
    for (std::uint32_t t = 0; t < count; ++t) {
        const int piece = piece_of_triangle[t];
        if (piece == kNoPanel) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const auto twin = twin_of(t, k);
            const int neighbour = twin == kNone ? kNoPanel : piece_of_triangle[twin / 3];
            if (neighbour == piece) continue;
            const auto from = posts.of_triangle[t][static_cast<int>(k)];
            const auto to = posts.of_triangle[t][static_cast<int>((k + 1) % 3)];
            const auto on_plane = [&](std::uint32_t post) {
                return sheet.vertices[posts.vertex[post]].position.z == 0.0;
            };
            if (twin == kNone && on_plane(from) && on_plane(to)) {
                // The mirror image joins on there.
                posts.on_centre[from] = posts.on_centre[to] = true;
                continue;
            }
            posts.borders.push_back({from, to, neighbour, sheet.triangles[t].region});
        }
    }
    return posts;
}

}  // namespace livery::assets
