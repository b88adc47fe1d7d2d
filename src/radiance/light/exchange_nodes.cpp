#include "radiance/light/exchange_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "tracing/tracer.h"

namespace livery {

namespace {

constexpr double kOfDiagonal = 0.01;
constexpr std::size_t kMostGridPoints = 100000;
constexpr int kMostSteps = 255;

/// Nodes whose normals are farther apart than this do not light one place together.
constexpr float kSameSide = 0.5f;

float longest_side_mm(const Mesh& mesh, std::size_t triangle) {
    const glm::uvec3 c = mesh.triangles[triangle];
    const auto side = [&](unsigned a, unsigned b) {
        return glm::distance(mesh.positions_mm[a], mesh.positions_mm[b]);
    };
    return std::max({side(c.x, c.y), side(c.y, c.z), side(c.z, c.x)});
}

std::size_t points_of_grid(int steps) {
    const auto n = static_cast<std::size_t>(steps);
    return steps == 1 ? 0 : (n + 1) * (n + 2) / 2;
}

/// Rows of a grid lie one behind another, each shorter by one.
std::uint32_t place_in_grid(int steps, int i, int j) {
    return static_cast<std::uint32_t>(j * (steps + 1) - j * (j - 1) / 2 + i);
}

/// Triangles up to twice as long as that are as good as a grid.
int steps_for(float side_mm, double apart_mm) {
    if (!(side_mm > 2.0 * apart_mm)) return 1;
    return static_cast<int>(
        std::min(std::ceil(static_cast<double>(side_mm) / apart_mm), 1.0 * kMostSteps));
}

std::size_t grid_points(const std::vector<float>& sides_mm, double apart_mm) {
    std::size_t count = 0;
    for (const float side : sides_mm) count += points_of_grid(steps_for(side, apart_mm));
    return count;
}

template <typename T>
T mixed(const T& a, const T& b, const T& c, float u, float v) {
    return (1.0f - u - v) * a + u * b + v * c;
}

void add_grid(const Mesh& mesh, std::size_t triangle, int steps, ExchangePoints& points) {
    const glm::uvec3 c = mesh.triangles[triangle];
    const std::uint16_t part = mesh.triangle_part[triangle];
    for (int j = 0; j <= steps; ++j) {
        for (int i = 0; i + j <= steps; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(steps);
            const float v = static_cast<float>(j) / static_cast<float>(steps);
            const auto& p = mesh.positions_mm;
            const auto& n = mesh.normals;
            const glm::vec3 normal = mixed(n[c.x], n[c.y], n[c.z], u, v);
            const float length = glm::length(normal);
            points.positions_mm.push_back(mixed(p[c.x], p[c.y], p[c.z], u, v));
            points.normals.push_back(length > 0.0f ? normal / length : n[c.x]);
            points.within.push_back(static_cast<std::uint32_t>(triangle));
            points.uvs.push_back(mixed(mesh.uvs[c.x], mesh.uvs[c.y], mesh.uvs[c.z], u, v));
            points.part.push_back(part);
        }
    }
}

/// Points that share their place with those of two-sided triangles, on the other side.
void add_backs(const Mesh& mesh, ExchangePoints& points) {
    const std::size_t fronts = points.size();
    points.back.assign(fronts, ExchangePoints::kNoBack);
    const auto add = [&](std::uint32_t point) {
        if (points.back[point] != ExchangePoints::kNoBack) return;
        points.back[point] = static_cast<std::uint32_t>(points.size());
        points.positions_mm.push_back(points.positions_mm[point]);
        points.normals.push_back(-points.normals[point]);
        points.within.push_back(points.within[point]);
        points.uvs.push_back(points.uvs[point]);
        points.part.push_back(points.part[point]);
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!mesh.two_sided[t]) continue;
        for (int k = 0; k < 3; ++k) add(mesh.triangles[t][k]);
        const auto in_grid = static_cast<std::uint32_t>(points_of_grid(points.steps[t]));
        for (std::uint32_t k = 0; k < in_grid; ++k) add(points.grid[t] + k);
    }
    points.back.resize(points.size(), ExchangePoints::kNoBack);
}

ExchangePoints points_on(const Mesh& mesh, double& apart_mm) {
    ExchangePoints points;
    points.positions_mm = mesh.positions_mm;
    points.normals = mesh.normals;
    points.within.assign(mesh.positions_mm.size(), 0);
    points.uvs = mesh.uvs;
    points.part.assign(mesh.positions_mm.size(), 0);
    std::vector<float> sides_mm(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3 c = mesh.triangles[t];
        sides_mm[t] = longest_side_mm(mesh, t);
        for (int k = 0; k < 3; ++k) {
            points.part[c[k]] = mesh.triangle_part[t];
            points.within[c[k]] = static_cast<std::uint32_t>(t);
        }
    }
    while (grid_points(sides_mm, apart_mm) > kMostGridPoints) apart_mm *= 1.25;
    points.steps.assign(mesh.triangles.size(), 1);
    points.grid.assign(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const int steps = steps_for(sides_mm[t], apart_mm);
        if (steps == 1) continue;
        points.steps[t] = static_cast<std::uint16_t>(steps);
        points.grid[t] = static_cast<std::uint32_t>(points.size());
        add_grid(mesh, t, steps, points);
    }
    if (!mesh.two_sided.empty()) add_backs(mesh, points);
    return points;
}

/// Cubes of space, each with its nodes.
class NodeCells {
  public:
    NodeCells(const Mesh& mesh, float side_mm) : low_mm_(bounds_of(mesh).low), side_mm_(side_mm) {}

    glm::vec3 place(const glm::vec3& position_mm) const {
        return (position_mm - low_mm_) / side_mm_;
    }
    static std::uint64_t key(const glm::ivec3& cell) {
        const auto of = [](int v) { return static_cast<std::uint64_t>(v + 1) & 0x1fffffu; };
        return of(cell.x) | of(cell.y) << 21u | of(cell.z) << 42u;
    }
    std::vector<std::uint32_t>& at(const glm::ivec3& cell) { return nodes_[key(cell)]; }
    const std::vector<std::uint32_t>* find(const glm::ivec3& cell) const {
        const auto found = nodes_.find(key(cell));
        return found == nodes_.end() ? nullptr : &found->second;
    }

  private:
    glm::vec3 low_mm_;
    float side_mm_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> nodes_;
};

/// The points that share a node, on the way to choosing it.
struct Cluster {
    glm::vec3 position{0.0f}, normal{0.0f};  ///< means
    float count = 0.0f;
    glm::vec3 first_normal{0.0f};
    std::uint16_t part = 0;
    std::uint32_t point = 0;
    float distance = std::numeric_limits<float>::infinity();
};

void cluster(NodeCells& cells, ExchangeNodes& nodes) {
    const ExchangePoints& points = nodes.points;
    std::vector<Cluster> clusters;
    nodes.node_of.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 at = cells.place(points.positions_mm[i]);
        auto& here = cells.at(glm::ivec3(glm::floor(at)));
        const auto found = std::find_if(here.begin(), here.end(), [&](std::uint32_t c) {
            return clusters[c].part == points.part[i] &&
                   glm::dot(clusters[c].first_normal, points.normals[i]) > kSameSide;
        });
        std::uint32_t index = 0;
        if (found != here.end()) {
            index = *found;
        } else {
            index = static_cast<std::uint32_t>(clusters.size());
            here.push_back(index);
            Cluster& made = clusters.emplace_back();
            made.first_normal = points.normals[i];
            made.part = points.part[i];
        }
        Cluster& own = clusters[index];
        own.position += at;
        own.normal += points.normals[i];
        own.count += 1.0f;
        nodes.node_of[i] = index;
    }
    // The point in the middle
    for (std::size_t i = 0; i < points.size(); ++i) {
        Cluster& own = clusters[nodes.node_of[i]];
        const glm::vec3 off = cells.place(points.positions_mm[i]) - own.position / own.count;
        const glm::vec3 turned = points.normals[i] - own.normal / own.count;
        const float distance = glm::dot(off, off) + glm::dot(turned, turned);
        if (distance >= own.distance) continue;
        own.distance = distance;
        own.point = static_cast<std::uint32_t>(i);
    }
    for (const Cluster& one : clusters) nodes.point_of.push_back(one.point);
}

/// Nodes within a cell and a half of a point, the nearer the more, of its part and its side.
void find_nearby(const NodeCells& cells, ExchangeNodes& nodes) {
    constexpr float kReach = 1.5f;
    const ExchangePoints& points = nodes.points;
    constexpr std::size_t kAtATime = 2048;
    std::vector<std::vector<ExchangePoints::Share>> found((points.size() + kAtATime - 1) /
                                                          kAtATime);
    nodes.first.assign(points.size() + 1, 0);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            std::vector<ExchangePoints::Share>& list = found[block];
            const std::size_t past = std::min(points.size(), (block + 1) * kAtATime);
            for (std::size_t i = block * kAtATime; i < past; ++i) {
                const glm::vec3 at = cells.place(points.positions_mm[i]);
                const std::size_t before = list.size();
                float sum = 0.0f;
                const glm::ivec3 low(glm::floor(at - kReach)), high(glm::floor(at + kReach));
                for (int z = low.z; z <= high.z; ++z) {
                    for (int y = low.y; y <= high.y; ++y) {
                        for (int x = low.x; x <= high.x; ++x) {
                            const auto* here = cells.find({x, y, z});
                            if (!here) continue;
                            for (const std::uint32_t node : *here) {
                                if (nodes.part(node) != points.part[i]) continue;
                                const float turn = glm::dot(nodes.normal(node), points.normals[i]);
                                const float near =
                                    1.0f - glm::distance(cells.place(nodes.position_mm(node)), at) /
                                               kReach;
                                if (turn <= kSameSide || near <= 0.0f) continue;
                                const float weight = near * near * (turn - kSameSide);
                                list.push_back({node, weight});
                                sum += weight;
                            }
                        }
                    }
                }
                if (sum <= 0.0f) {
                    list.resize(before);
                    list.push_back({nodes.node_of[i], sum = 1.0f});
                }
                for (std::size_t k = before; k < list.size(); ++k) list[k].weight /= sum;
                nodes.first[i + 1] = static_cast<std::uint32_t>(list.size() - before);
            }
        }
    });
    for (std::size_t i = 0; i < points.size(); ++i) nodes.first[i + 1] += nodes.first[i];
    nodes.nearby.reserve(nodes.first.back());
    for (const auto& list : found) {
        nodes.nearby.insert(nodes.nearby.end(), list.begin(), list.end());
    }
}

/// On the side of the shading normal: the surface itself hides what lies under it.
glm::vec3 off_surface(const Mesh& mesh,
                      std::size_t triangle,
                      const glm::vec3& place,
                      const glm::vec3& normal) {
    const glm::uvec3 c = mesh.triangles[triangle];
    const glm::vec3 a = mesh.positions_mm[c.x];
    const glm::vec3 across = glm::cross(mesh.positions_mm[c.y] - a, mesh.positions_mm[c.z] - a);
    const float twice_area = glm::length(across);
    const glm::vec3 outward = twice_area > 0.0f ? across / twice_area : normal;
    return offset_origin(place, glm::dot(outward, normal) < 0.0f ? -outward : outward);
}

/// What of a triangle of points is nearest to one of its corners.
struct Third {
    std::size_t triangle = 0;  ///< of the mesh
    std::uint32_t point = 0;
    glm::vec3 middle_mm{0.0f};
    double area_mm2 = 0.0;
};
template <typename Visit>
void for_each_third(const Mesh& mesh, const ExchangePoints& points, const Visit& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3 c = mesh.triangles[t];
        const glm::dvec3 a(mesh.positions_mm[c.x]);
        const double whole = 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions_mm[c.y]) - a,
                                                          glm::dvec3(mesh.positions_mm[c.z]) - a));
        const int n = points.steps[t];
        const auto add = [&](const glm::uvec3& corners) {
            for (int k = 0; k < 3; ++k) {
                const auto at = [&](int corner) {
                    return points.positions_mm[corners[(k + corner) % 3]];
                };
                visit({t,
                       corners[k],
                       (22.0f * at(0) + 7.0f * (at(1) + at(2))) / 36.0f,
                       whole / (3.0 * n * n)});
            }
        };
        if (n == 1) {
            add(c);
            continue;
        }
        const auto point = [&](int i, int j) { return points.grid[t] + place_in_grid(n, i, j); };
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i + j < n; ++i) {
                add({point(i, j), point(i + 1, j), point(i, j + 1)});
                if (i + j + 2 > n) continue;
                add({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
            }
        }
    }
}

}  // namespace

ExchangeNodes exchange_nodes(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh);
    return exchange_nodes(mesh, kOfDiagonal * glm::distance(bounds.low, bounds.high));
}

ExchangeNodes exchange_nodes(const Mesh& mesh, double apart_mm) {
    ExchangeNodes nodes;
    nodes.points = points_on(mesh, apart_mm);
    nodes.points.apart_mm = static_cast<float>(apart_mm);
    NodeCells cells(mesh, static_cast<float>(apart_mm));
    cluster(cells, nodes);
    find_nearby(cells, nodes);
    return nodes;
}

std::vector<float> node_areas_mm2(const Mesh& mesh, const ExchangeNodes& nodes) {
    std::vector<double> areas(nodes.size(), 0.0);
    for_each_third(mesh, nodes.points, [&](const Third& third) {
        areas[nodes.node_of[third.point]] += third.area_mm2;
    });
    return {areas.begin(), areas.end()};
}

std::vector<glm::vec3> ray_origins_mm(const Mesh& mesh,
                                      const ExchangeNodes& nodes,
                                      std::span<const float> areas_mm2,
                                      std::size_t count) {
    std::vector<glm::vec3> origins(nodes.size() * count);
    std::vector<double> passed_mm2(nodes.size(), 0.0);
    std::vector<std::size_t> found(nodes.size(), 0);
    for_each_third(mesh, nodes.points, [&](const Third& third) {
        const std::uint32_t node = nodes.node_of[third.point];
        passed_mm2[node] += third.area_mm2;
        const double apart_mm2 = static_cast<double>(areas_mm2[node]) / static_cast<double>(count);
        std::size_t& next = found[node];
        if (!((static_cast<double>(next) + 0.5) * apart_mm2 < passed_mm2[node])) return;
        const glm::vec3 origin =
            off_surface(mesh, third.triangle, third.middle_mm, nodes.points.normals[third.point]);
        while (next < count && (static_cast<double>(next) + 0.5) * apart_mm2 < passed_mm2[node]) {
            origins[node * count + next++] = origin;
        }
    });
    // What rounding has left, and nodes without area
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        while (found[i] < count) origins[i * count + found[i]++] = nodes.ray_origin_mm(mesh, i);
    }
    return origins;
}

glm::vec3 ExchangeNodes::ray_origin_mm(const Mesh& mesh, std::size_t node) const {
    constexpr float kInside = 0.1f;
    const std::uint32_t point = point_of[node];
    const glm::uvec3 c = mesh.triangles[points.within[point]];
    const glm::vec3 corner[] = {
        mesh.positions_mm[c.x], mesh.positions_mm[c.y], mesh.positions_mm[c.z]};
    glm::vec3 place = points.positions_mm[point];
    const glm::vec3 inward = (corner[0] + corner[1] + corner[2]) / 3.0f - place;
    const float length = glm::length(inward);
    if (length > 0.0f) place += std::min(1.0f, kInside * points.apart_mm / length) * inward;
    return off_surface(mesh, points.within[point], place, points.normals[point]);
}

std::uint32_t ExchangeNodes::around(const Mesh& mesh,
                                    std::uint32_t triangle,
                                    const glm::vec2& barycentric,
                                    bool behind,
                                    float chance) const {
    for (const ExchangePoints::Share& share : points.around(mesh, triangle, barycentric)) {
        const std::uint32_t point = behind ? points.back[share.index] : share.index;
        for (std::size_t k = first[point]; k < first[point + 1]; ++k) {
            chance -= share.weight * nearby[k].weight;
            if (chance < 0.0f) return nearby[k].index;
        }
    }
    // What rounding has left
    const std::uint32_t corner = mesh.triangles[triangle].x;
    return node_of[behind ? points.back[corner] : corner];
}

std::vector<glm::vec3> ExchangeNodes::at_points(const std::vector<glm::vec3>& at_nodes) const {
    std::vector<glm::vec3> values(points.size());
    parallel_for(values.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            glm::vec3 sum(0.0f);
            for (std::size_t k = first[i]; k < first[i + 1]; ++k) {
                sum += nearby[k].weight * at_nodes[nearby[k].index];
            }
            values[i] = sum;
        }
    });
    return values;
}

std::vector<glm::vec3> ExchangeNodes::sharpened(const std::vector<glm::vec3>& at_nodes,
                                                float blur) const {
    const std::vector<glm::vec3> blurred = at_points(at_nodes);
    std::vector<glm::vec3> values(at_nodes.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const glm::vec3 lost = at_nodes[i] - blurred[point_of[i]];
        values[i] = glm::max(at_nodes[i] + blur * lost, glm::vec3(0.0f));
    }
    return values;
}

std::array<ExchangePoints::Share, 3> ExchangePoints::around(const Mesh& mesh,
                                                            std::uint32_t triangle,
                                                            const glm::vec2& barycentric) const {
    const float u = std::clamp(barycentric.x, 0.0f, 1.0f);
    const float v = std::clamp(barycentric.y, 0.0f, 1.0f - u);
    const int n = steps[triangle];
    if (n == 1) {
        const glm::uvec3 c = mesh.triangles[triangle];
        return {{{c.x, 1.0f - u - v}, {c.y, u}, {c.z, v}}};
    }
    const float x = u * static_cast<float>(n), y = v * static_cast<float>(n);
    const int i = std::min(static_cast<int>(x), n - 1);
    const int j = std::min(static_cast<int>(y), n - 1 - i);
    const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
    const auto point = [&](int column, int row) {
        return grid[triangle] + place_in_grid(n, column, row);
    };
    // Each cell but the last of a row is two triangles
    if (fx + fy <= 1.0f || i + j + 2 > n) {
        return {{{point(i, j), 1.0f - fx - fy}, {point(i + 1, j), fx}, {point(i, j + 1), fy}}};
    }
    return {{{point(i + 1, j + 1), fx + fy - 1.0f},
             {point(i + 1, j), 1.0f - fy},
             {point(i, j + 1), 1.0f - fx}}};
}

}  // namespace livery
