#include "radiance/light/subsurface_transport.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"

namespace livery {

namespace {

/// More would take seconds for what nobody sees: nodes are farther apart then.
constexpr double kMostNodes = 60'000.0;
/// A surface crosses about that many cells of the nodes' grid per side squared.
constexpr double kCellsCrossed = 1.5;
constexpr int kSkyRays = 32;

double area_of(const Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& c : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_mm[c.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions_mm[c.y]) - a,
                                             glm::dvec3(mesh.positions_mm[c.z]) - a));
    }
    return area;
}

void take_part(const Mesh& product, SubsurfaceTransport& transport) {
    Mesh& mesh = transport.mesh;
    std::vector<std::uint32_t> place(product.positions_mm.size(), kNoTriangle);
    transport.place_of.assign(product.triangles.size(), kNoTriangle);
    for (std::size_t t = 0; t < product.triangles.size(); ++t) {
        if (product.triangle_part[t] != transport.part) continue;
        glm::uvec3 corners = product.triangles[t];
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = corners[k];
            if (place[vertex] == kNoTriangle) {
                place[vertex] = static_cast<std::uint32_t>(mesh.positions_mm.size());
                mesh.positions_mm.push_back(product.positions_mm[vertex]);
                mesh.normals.push_back(product.normals[vertex]);
                mesh.uvs.push_back(product.uvs[vertex]);
            }
            corners[k] = place[vertex];
        }
        transport.place_of[t] = static_cast<std::uint32_t>(mesh.triangles.size());
        mesh.triangles.push_back(corners);
    }
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    mesh.parts.resize(1);
}

/// Nodes in cubes as wide as the reach.
class ReachCells {
  public:
    ReachCells(const ExchangeNodes& nodes, float reach_mm) : reach_mm_(reach_mm) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            cells_[key(cell_of(nodes.position_mm(i)))].push_back(static_cast<std::uint32_t>(i));
        }
    }
    template <typename Visit>
    void around(const glm::vec3& position, const Visit& visit) const {
        const glm::ivec3 middle = cell_of(position);
        for (int z = -1; z <= 1; ++z) {
            for (int y = -1; y <= 1; ++y) {
                for (int x = -1; x <= 1; ++x) {
                    const auto found = cells_.find(key(middle + glm::ivec3(x, y, z)));
                    if (found == cells_.end()) continue;
                    for (const std::uint32_t node : found->second) visit(node);
                }
            }
        }
    }

  private:
    glm::ivec3 cell_of(const glm::vec3& position) const {
        return glm::ivec3(glm::floor(position / reach_mm_));
    }
    static std::uint64_t key(const glm::ivec3& cell) {
        const auto of = [](int v) { return static_cast<std::uint64_t>(v + 0x100000) & 0x1fffffu; };
        return of(cell.x) | of(cell.y) << 21u | of(cell.z) << 42u;
    }
    float reach_mm_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

/// Whether light could go the straight way: a little under the surface at both ends, and never out
/// of it. What is nearly flat between has no air in it.
bool through_air(const Tracer& tracer,
                 const ExchangeNodes& nodes,
                 std::size_t i,
                 std::size_t j,
                 float distance) {
    const glm::vec3 n = nodes.normal(i), m = nodes.normal(j);
    const glm::vec3 way = nodes.position_mm(j) - nodes.position_mm(i);
    constexpr float kFlat = 0.35f, kUnder = 0.25f;
    if (glm::dot(n, m) > 0.5f && std::abs(glm::dot(way, n)) < kFlat * distance &&
        std::abs(glm::dot(way, m)) < kFlat * distance) {
        return false;
    }
    TraceRay ray;
    ray.origin = nodes.position_mm(i) - kUnder * distance * n;
    ray.direction = nodes.position_mm(j) - kUnder * distance * m - ray.origin;
    ray.t_max = 1.0f;
    return tracer.occluded(ray);
}

void find_others(const Tracer& tracer,
                 const TransportDetail& detail,
                 SubsurfaceTransport& transport,
                 const Progress& progress) {
    const ExchangeNodes& nodes = transport.exchange.nodes;
    const ReachCells cells(nodes, transport.reach_mm);
    struct Found {
        std::vector<std::uint32_t> other;
        std::vector<std::uint16_t> code;
    };
    constexpr std::size_t kAtATime = 256;
    std::vector<Found> found((nodes.size() + kAtATime - 1) / kAtATime);
    transport.first.assign(nodes.size() + 1, 0);
    transport.curvature_per_mm.assign(nodes.size(), 0.0f);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t block = begin; block < end; ++block) {
            Found& list = found[block];
            const std::size_t past = std::min(nodes.size(), (block + 1) * kAtATime);
            for (std::size_t i = block * kAtATime; i < past; ++i) {
                const std::size_t before = list.other.size();
                float bent = 0.0f, all = 0.0f;
                cells.around(nodes.position_mm(i), [&](std::uint32_t j) {
                    if (j == i) return;
                    const glm::vec3 way = nodes.position_mm(j) - nodes.position_mm(i);
                    // The mean of 1/r over a disc is about its value half a radius farther out
                    const float square = glm::dot(way, way) +
                                         transport.area_mm2[j] / (8.0f * std::numbers::pi_v<float>);
                    if (square >= transport.reach_mm * transport.reach_mm) return;
                    const float distance = std::sqrt(square);
                    if (detail.rejects_air && through_air(tracer, nodes, i, j, distance)) return;
                    // A chord of a ball leaves its tangent plane by length^2 / (2 radius)
                    const float weight = transport.area_mm2[j] / distance;
                    bent -= weight * 2.0f * glm::dot(nodes.normal(i), way) / square;
                    all += weight;
                    list.other.push_back(j);
                    list.code.push_back(distance_code(distance, transport.reach_mm));
                });
                if (all > 0.0f) transport.curvature_per_mm[i] = bent / all;
                transport.first[i + 1] = static_cast<std::uint32_t>(list.other.size() - before);
            }
        }
    });
    for (std::size_t i = 0; i < nodes.size(); ++i) transport.first[i + 1] += transport.first[i];
    transport.other.reserve(transport.first.back());
    transport.code.reserve(transport.first.back());
    for (Found& list : found) {
        transport.other.insert(transport.other.end(), list.other.begin(), list.other.end());
        transport.code.insert(transport.code.end(), list.code.begin(), list.code.end());
        list = {};
    }
}

}  // namespace

SubsurfaceTransport solve_transport(const Mesh& product,
                                    const Tracer& tracer,
                                    std::size_t part,
                                    float reach_mm,
                                    const TransportDetail& detail,
                                    const Progress& progress) {
    SubsurfaceTransport transport;
    transport.part = part;
    transport.reach_mm = reach_mm;
    take_part(product, transport);
    const double within = std::numbers::pi * static_cast<double>(reach_mm * reach_mm);
    const double cell_mm2 = std::max(kCellsCrossed * within / detail.neighbours,
                                     kCellsCrossed * area_of(transport.mesh) / kMostNodes);
    transport.exchange = blocked_directions(transport.mesh,
                                            tracer,
                                            exchange_nodes(transport.mesh, std::sqrt(cell_mm2)),
                                            kSkyRays,
                                            progress);
    transport.area_mm2 = node_areas_mm2(transport.mesh, transport.exchange.nodes);
    find_others(tracer, detail, transport, progress);
    return transport;
}

std::vector<glm::vec3> leaving_at_nodes(const SubsurfaceTransport& transport,
                                        const SubsurfaceKernel& kernel,
                                        std::span<const glm::vec3> entering,
                                        const Progress& progress) {
    std::vector<glm::vec3> power(entering.size());
    for (std::size_t i = 0; i < power.size(); ++i) power[i] = transport.area_mm2[i] * entering[i];
    std::vector<glm::vec3> leaving(entering.size());
    parallel_for(leaving.size(), 512, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t i = begin; i < end; ++i) {
            const float own_radius = std::sqrt(transport.area_mm2[i] / std::numbers::pi_v<float>);
            const glm::vec3 own = kernel.within[distance_code(own_radius, transport.reach_mm)];
            glm::vec3 sum = own * entering[i], all = own;
            for (std::size_t k = transport.first[i]; k < transport.first[i + 1]; ++k) {
                const glm::vec3& weight = kernel.per_mm2[transport.code[k]];
                const std::uint32_t j = transport.other[k];
                sum += weight * power[j];
                all += transport.area_mm2[j] * weight;
            }
            leaving[i] = total_at(kernel, transport.curvature_per_mm[i]) * sum /
                         glm::max(all, glm::vec3(1e-20f));
        }
    });
    return leaving;
}

std::vector<glm::vec3> at_part_nodes(const Mesh& product,
                                     const ExchangeNodes& nodes,
                                     const std::vector<glm::vec3>& at_nodes,
                                     const SubsurfaceTransport& transport) {
    const std::vector<glm::vec3> at_points = nodes.at_points(at_nodes);
    std::vector<std::uint32_t> of_product(transport.mesh.triangles.size());
    for (std::size_t t = 0; t < transport.place_of.size(); ++t) {
        if (transport.place_of[t] != kNoTriangle) {
            of_product[transport.place_of[t]] = static_cast<std::uint32_t>(t);
        }
    }
    const ExchangeNodes& own = transport.exchange.nodes;
    std::vector<glm::vec3> values(own.size(), glm::vec3(0.0f));
    parallel_for(values.size(), 2048, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t triangle = own.points.within[own.point_of[i]];
            const glm::uvec3 c = transport.mesh.triangles[triangle];
            const glm::vec3 a = transport.mesh.positions_mm[c.x];
            const glm::vec3 e = transport.mesh.positions_mm[c.y] - a;
            const glm::vec3 f = transport.mesh.positions_mm[c.z] - a;
            const glm::vec3 p = own.position_mm(i) - a;
            const float ee = glm::dot(e, e), ef = glm::dot(e, f), ff = glm::dot(f, f);
            const float all = ee * ff - ef * ef;
            if (!(all > 0.0f)) continue;
            const glm::vec2 at((ff * glm::dot(p, e) - ef * glm::dot(p, f)) / all,
                               (ee * glm::dot(p, f) - ef * glm::dot(p, e)) / all);
            for (const auto& share : nodes.points.around(product, of_product[triangle], at)) {
                values[i] += share.weight * at_points[share.index];
            }
        }
    });
    return values;
}

std::shared_ptr<const SubsurfaceTransport> SharedTransports::of(const Mesh& product,
                                                                const Tracer& tracer,
                                                                std::size_t part,
                                                                float reach_mm,
                                                                const TransportDetail& detail,
                                                                const Progress& progress) {
    const std::scoped_lock lock(mutex_);
    Made& made = of_part_[part];
    if (!made.transport || made.transport->reach_mm != reach_mm || made.detail != detail) {
        made = {detail,
                std::make_shared<const SubsurfaceTransport>(
                    solve_transport(product, tracer, part, reach_mm, detail, progress))};
    }
    return made.transport;
}

}  // namespace livery
