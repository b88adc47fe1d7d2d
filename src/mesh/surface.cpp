#include "mesh/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

#include "mesh/number_table.h"

namespace livery {

namespace {

std::uint64_t hash_of(const glm::vec3& point) {
    const auto bits = [](float value) {
        // -0 is 0.
        return std::uint64_t{std::bit_cast<std::uint32_t>(value + 0.0f)};
    };
    std::uint64_t hash = bits(point.x) | (bits(point.y) << 32u);
    hash = (hash ^ (bits(point.z) * 0x9e3779b97f4a7c15ull)) * 0xd6e8feb86659fd93ull;
    hash = (hash ^ (hash >> 32u)) * 0xd6e8feb86659fd93ull;
    return hash ^ (hash >> 32u);
}

}  // namespace

std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& points,
                                std::vector<glm::vec3>& distinct) {
    const std::size_t slots = std::bit_ceil(2 * points.size() + 1);
    std::vector<std::uint32_t> table(slots, Surface::none), place(points.size());
    distinct.clear();
    for (std::size_t k = 0; k < points.size(); ++k) {
        std::size_t slot = hash_of(points[k]) & (slots - 1);
        while (table[slot] != Surface::none && distinct[table[slot]] != points[k]) {
            slot = (slot + 1) & (slots - 1);
        }
        if (table[slot] == Surface::none) {
            table[slot] = static_cast<std::uint32_t>(distinct.size());
            distinct.push_back(points[k]);
        }
        place[k] = table[slot];
    }
    return place;
}

void find_neighbours(Surface& surface) {
    const std::size_t count = surface.triangles.size();
    surface.neighbours.assign(count, {Surface::none, Surface::none, Surface::none});
    surface.lone.assign(count, false);

    // Every edge stands at its lower point, sorted by the other; equal ones are one edge.
    struct Edge {
        std::uint32_t other, at;  ///< at: 3 triangle + corner
    };
    std::vector<std::uint32_t> first(surface.points.size() + 1, 0);
    const auto edge_points = [&](std::size_t triangle, int corner) {
        const glm::uvec3& t = surface.triangles[triangle];
        return std::minmax({t[corner], t[(corner + 1) % 3]});
    };
    for (std::size_t t = 0; t < count; ++t) {
        for (int k = 0; k < 3; ++k) ++first[edge_points(t, k).first + 1];
    }
    for (std::size_t p = 0; p + 1 < first.size(); ++p) first[p + 1] += first[p];
    std::vector<Edge> edges(3 * count);
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t t = 0; t < count; ++t) {
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = edge_points(t, k);
            edges[next[low]++] = {high,
                                  static_cast<std::uint32_t>(3 * t) + static_cast<unsigned>(k)};
        }
    }
    for (std::size_t p = 0; p + 1 < first.size(); ++p) {
        const auto begin = edges.begin() + first[p], end = edges.begin() + first[p + 1];
        std::sort(begin, end, [](const Edge& a, const Edge& b) {
            return a.other != b.other ? a.other < b.other : a.at < b.at;
        });
        for (auto run = begin; run != end;) {
            const auto stop =
                std::find_if(run, end, [&](const Edge& one) { return one.other != run->other; });
            if (stop - run == 2) {
                surface.neighbours[run[0].at / 3][run[0].at % 3] = run[1].at / 3;
                surface.neighbours[run[1].at / 3][run[1].at % 3] = run[0].at / 3;
            } else {
                for (auto one = run; one != stop; ++one) surface.lone[one->at / 3] = true;
            }
            run = stop;
        }
    }
}

std::vector<bool> repeated_triangles(const Surface& surface) {
    const std::size_t count = surface.triangles.size();
    const auto sorted = [&](std::size_t t) {
        glm::uvec3 c = surface.triangles[t];
        if (c.x > c.y) std::swap(c.x, c.y);
        if (c.y > c.z) std::swap(c.y, c.z);
        if (c.x > c.y) std::swap(c.x, c.y);
        return c;
    };
    std::vector<bool> repeats(count, false);
    NumberTable table(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::uvec3 c = sorted(t);
        const std::uint64_t hash =
            (std::uint64_t{c.x} * 0x9e3779b97f4a7c15ull) ^ (std::uint64_t{c.y} << 32u) ^ c.z;
        repeats[t] = table.find_or_add(
                         hash, t, [&](std::uint32_t other) { return sorted(other) == c; }) != t;
    }
    return repeats;
}

glm::dvec3 area_vector(const Surface& surface, std::size_t triangle) {
    const glm::uvec3& t = surface.triangles[triangle];
    const glm::dvec3 a(surface.points[t.x]);
    return glm::cross(glm::dvec3(surface.points[t.y]) - a, glm::dvec3(surface.points[t.z]) - a);
}

bool has_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a, bc = c - b;
    const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    // A needle a million times longer than wide is below the resolution of float coordinates.
    return glm::length(glm::cross(ab, ac)) > 1e-7 * longest;
}

namespace {

/// Sets of corners that share a normal.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t root(std::uint32_t k) {
        while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
        return k;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t corner_at(const Surface& surface, std::uint32_t triangle, std::uint32_t point) {
    const glm::uvec3& t = surface.triangles[triangle];
    return 3 * triangle + (t.x == point ? 0u : t.y == point ? 1u : 2u);
}

/// The angle between two edges, well-conditioned near 0 and pi.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

CornerNormals compute_corner_normals(const Surface& surface, double crease_rad) {
    const auto count = static_cast<std::uint32_t>(surface.triangles.size());
    std::vector<glm::dvec3> flat(count);
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::dvec3 vector = area_vector(surface, t);
        flat[t] = vector / glm::length(vector);
    }
    Sets sets(3 * std::size_t{count});
    const double least = std::cos(crease_rad);
    for (std::uint32_t t = 0; t < count; ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = surface.neighbours[t][static_cast<std::size_t>(k)];
            // Each edge once, from its later triangle.
            if (other >= t || glm::dot(flat[t], flat[other]) < least) continue;
            for (const int end : {k, (k + 1) % 3}) {
                sets.unite(3 * t + static_cast<std::uint32_t>(end),
                           corner_at(surface, other, surface.triangles[t][end]));
            }
        }
    }

    CornerNormals normals;
    normals.group.resize(count);
    std::vector<std::uint32_t> group_of_root(3 * std::size_t{count}, Surface::none);
    std::vector<glm::dvec3> sums;
    std::vector<std::uint32_t> a_triangle;  // of each group
    for (std::uint32_t t = 0; t < count; ++t) {
        const glm::uvec3& corners = surface.triangles[t];
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t& group = group_of_root[sets.root(3 * t + k)];
            if (group == Surface::none) {
                group = static_cast<std::uint32_t>(sums.size());
                sums.emplace_back(0.0);
                a_triangle.push_back(t);
            }
            const auto point = [&](std::uint32_t corner) {
                return glm::dvec3(surface.points[corners[static_cast<int>(corner % 3)]]);
            };
            const double angle = angle_between(point(k + 1) - point(k), point(k + 2) - point(k));
            sums[group] += angle * flat[t];
            normals.group[t][k] = group;
        }
    }
    normals.normal_of_group.reserve(sums.size());
    for (std::size_t group = 0; group < sums.size(); ++group) {
        const double length = glm::length(sums[group]);
        // All around a needle's tip normals cancel: one of them is as good as the others.
        normals.normal_of_group.emplace_back(length > 1e-9 ? sums[group] / length
                                                           : flat[a_triangle[group]]);
    }
    return normals;
}

}  // namespace livery
