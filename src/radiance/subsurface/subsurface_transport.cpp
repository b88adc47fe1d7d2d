#include "radiance/subsurface/subsurface_transport.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "radiance/subsurface/slab_thickness.h"

namespace livery {

namespace {

/// More would take seconds for what nobody sees: nodes are farther apart then.
constexpr double kMostNodes = 60'000.0;
/// A surface crosses about that many cells of the nodes' grid per side squared.
constexpr double kCellsCrossed = 1.5;
constexpr int kPlaceSkyRays = 32;
/// Nodes of sheets, over those of bodies, at most.
constexpr double kMoreForSlabs = 4.0;
/// Classes of thickness; those that are thicker than all of them count as deep.
constexpr std::size_t kMostSlabs = 24;
/// Of the normals on both sides of a slab, the cosine between them at most.
constexpr float kOpposite = -0.7f;

double area_of(const Mesh& mesh) {
    double area = 0.0;
    for (const glm::uvec3& c : mesh.triangles) {
        const glm::dvec3 a(mesh.positions_mm[c.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions_mm[c.y]) - a,
                                             glm::dvec3(mesh.positions_mm[c.z]) - a));
    }
    return area;
}

/// Corners in the same order: a place of a triangle has the same coordinates on both sides.
void add_other_side(SubsurfaceTransport& transport) {
    Mesh& mesh = transport.mesh;
    const std::size_t vertices = mesh.positions_mm.size(), triangles = mesh.triangles.size();
    for (std::size_t v = 0; v < vertices; ++v) {
        const glm::vec3 normal = mesh.normals[v], position = mesh.positions_mm[v];
        mesh.positions_mm.push_back(position - transport.sheet_mm * normal);
        mesh.normals.push_back(-normal);
        const glm::vec2 uv = mesh.uvs[v];
        mesh.uvs.push_back(uv);
    }
    for (std::size_t t = 0; t < triangles; ++t) {
        const glm::uvec3 front = mesh.triangles[t];
        mesh.triangles.push_back(front + static_cast<std::uint32_t>(vertices));
    }
    transport.behind_of = transport.place_of;
    for (std::uint32_t& triangle : transport.behind_of) {
        if (triangle != kNoTriangle) triangle += static_cast<std::uint32_t>(triangles);
    }
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
    if (transport.sheet_mm > 0.0f) add_other_side(transport);
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
                 const Mesh& mesh,
                 const ExchangeNodes& nodes,
                 std::size_t i,
                 std::size_t j,
                 float distance,
                 float thickness) {
    const glm::vec3 n = nodes.normal(i), m = nodes.normal(j);
    const glm::vec3 way = nodes.position_mm(j) - nodes.position_mm(i);
    constexpr float kFlat = 0.35f, kUnder = 0.25f;
    if (glm::dot(n, m) > 0.5f && std::abs(glm::dot(way, n)) < kFlat * distance &&
        std::abs(glm::dot(way, m)) < kFlat * distance) {
        return false;
    }
    TraceRay ray;
    const float under = std::min(kUnder * distance, kUnder * thickness);
    // At an edge they would lie within the faces that meet there
    ray.origin = nodes.ray_origin_mm(mesh, i) - under * n;
    ray.direction = nodes.ray_origin_mm(mesh, j) - under * m - ray.origin;
    ray.t_max = 1.0f;
    return tracer.occluded(ray);
}

/// Sorts the nodes' thicknesses into classes a fifth apart.
void find_slabs(const Tracer& tracer, const Mesh& product, SubsurfaceTransport& transport) {
    const ExchangeNodes& nodes = transport.exchange.nodes;
    std::vector<float> thickness(nodes.size());
    if (transport.sheet_mm > 0.0f) {
        transport.slabs_mm = {transport.sheet_mm};
        transport.slab_of.assign(nodes.size(), 0);
        return;
    }
    parallel_for(nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            thickness[i] = slab_thickness_mm(tracer,
                                             product,
                                             transport.part,
                                             nodes.position_mm(i),
                                             nodes.normal(i),
                                             transport.reach_mm)
                               .value_or(0.0f);
        }
    });
    constexpr float kClass = 0.2f;  // of the logarithm
    std::map<int, std::pair<float, int>> classes;
    const auto class_of = [&](float mm) {
        return static_cast<int>(std::lround(std::log(mm) / kClass));
    };
    for (const float mm : thickness) {
        if (!(mm > 0.0f)) continue;
        auto& [sum, count] = classes[class_of(mm)];
        sum += mm;
        ++count;
    }
    std::map<int, std::uint8_t> place;
    for (const auto& [key, sums] : classes) {
        if (transport.slabs_mm.size() == kMostSlabs) break;
        place[key] = static_cast<std::uint8_t>(transport.slabs_mm.size());
        transport.slabs_mm.push_back(sums.first / static_cast<float>(sums.second));
    }
    transport.slab_of.assign(nodes.size(), SubsurfaceTransport::kDeep);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!(thickness[i] > 0.0f)) continue;
        const auto found = place.find(class_of(thickness[i]));
        if (found != place.end()) transport.slab_of[i] = found->second;
    }
}

void find_others(const Tracer& tracer,
                 const TransportDetail& detail,
                 SubsurfaceTransport& transport,
                 const Progress& progress) {
    const ExchangeNodes& nodes = transport.exchange.nodes;
    const ReachCells cells(nodes, transport.reach_mm);
    struct Found {
        std::vector<std::uint32_t> other, through;
        std::vector<std::uint16_t> code, through_code;
    };
    constexpr std::size_t kAtATime = 256;
    constexpr float kTold = 0.05f;  // nearer nodes tell rounding, and no curvature
    std::vector<Found> found((nodes.size() + kAtATime - 1) / kAtATime);
    transport.first.assign(nodes.size() + 1, 0);
    transport.through_first.assign(nodes.size() + 1, 0);
    transport.curvature_per_mm.assign(nodes.size(), 0.0f);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t block = begin; block < end; ++block) {
            Found& list = found[block];
            const std::size_t past = std::min(nodes.size(), (block + 1) * kAtATime);
            for (std::size_t i = block * kAtATime; i < past; ++i) {
                const std::size_t before = list.other.size();
                const std::size_t through_before = list.through.size();
                const std::uint8_t slab = transport.slab_of[i];
                const float thickness = slab == SubsurfaceTransport::kDeep
                                            ? std::numeric_limits<float>::infinity()
                                            : transport.slabs_mm[slab];
                float bent = 0.0f, all = 0.0f;
                // Itself: far light goes some way within what a node stands for
                list.other.push_back(static_cast<std::uint32_t>(i));
                list.code.push_back(0);
                cells.around(nodes.position_mm(i), [&](std::uint32_t j) {
                    if (j == i) return;
                    const glm::vec3 way = nodes.position_mm(j) - nodes.position_mm(i);
                    if (slab != SubsurfaceTransport::kDeep &&
                        glm::dot(nodes.normal(i), nodes.normal(j)) < kOpposite) {
                        const float depth = -glm::dot(way, nodes.normal(i));
                        const float along2 = std::max(glm::dot(way, way) - depth * depth, 0.0f);
                        const bool across = depth > 0.5f * thickness && depth < 2.0f * thickness;
                        if (!across || along2 >= transport.reach_mm * transport.reach_mm) return;
                        list.through.push_back(j);
                        list.through_code.push_back(
                            distance_code(std::sqrt(along2), transport.reach_mm));
                        return;
                    }
                    const float square = glm::dot(way, way);
                    if (square >= transport.reach_mm * transport.reach_mm) return;
                    const float distance = std::sqrt(square);
                    if (detail.rejects_air &&
                        through_air(tracer, transport.mesh, nodes, i, j, distance, thickness)) {
                        return;
                    }
                    // Where faces meet or cover one another nodes may lie in one place
                    if (distance > kTold * transport.near_mm &&
                        glm::dot(nodes.normal(i), nodes.normal(j)) > 0.0f) {
                        // A chord of a ball leaves its tangent plane by length^2 / (2 radius)
                        const float weight = transport.area_mm2[j] / distance;
                        bent -= weight * 2.0f * glm::dot(nodes.normal(i), way) / square;
                        all += weight;
                    }
                    list.other.push_back(j);
                    list.code.push_back(distance_code(distance, transport.reach_mm));
                });
                if (all > 0.0f) transport.curvature_per_mm[i] = bent / all;
                transport.first[i + 1] = static_cast<std::uint32_t>(list.other.size() - before);
                transport.through_first[i + 1] =
                    static_cast<std::uint32_t>(list.through.size() - through_before);
            }
        }
    });
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        transport.first[i + 1] += transport.first[i];
        transport.through_first[i + 1] += transport.through_first[i];
    }
    transport.other.reserve(transport.first.back());
    transport.code.reserve(transport.first.back());
    for (Found& list : found) {
        transport.other.insert(transport.other.end(), list.other.begin(), list.other.end());
        transport.code.insert(transport.code.end(), list.code.begin(), list.code.end());
        transport.through.insert(transport.through.end(), list.through.begin(), list.through.end());
        transport.through_code.insert(
            transport.through_code.end(), list.through_code.begin(), list.through_code.end());
        list = {};
    }
}

/// One side's lists of a transport: where each node's begin, the others, and their distances.
struct NodeLists {
    const std::vector<std::uint32_t>& first;
    const std::vector<std::uint32_t>& other;
    const std::vector<std::uint16_t>& code;
};

/// Of what enters at the nodes in node i's list, weighed by their areas and a kernel.
glm::vec3 mean_of(const NodeLists& lists,
                  std::size_t i,
                  std::span<const float> area_mm2,
                  std::span<const glm::vec3> kernel_per_mm2,
                  std::span<const glm::vec3> entering) {
    glm::vec3 sum(0.0f), all(0.0f);
    for (std::size_t k = lists.first[i]; k < lists.first[i + 1]; ++k) {
        const std::uint32_t j = lists.other[k];
        const glm::vec3 weight = area_mm2[j] * kernel_per_mm2[lists.code[k]];
        sum += weight * entering[j];
        all += weight;
    }
    return sum / glm::max(all, glm::vec3(1e-20f));
}

/// A wall that is bent lets less through from its larger side than a plane one, and more from its
/// smaller: by the root of the areas' ratio each, so that what goes either way between two places
/// is the same. Of the transmittance, that part is given back on the larger side.
float slab_bend(float curvature_per_mm, float thickness_mm) {
    constexpr float kMost = 0.5f;  // to first order
    return std::clamp(curvature_per_mm * thickness_mm, -kMost, kMost);
}

struct NodesOf {
    const Mesh& mesh;
    const ExchangeNodes& nodes;
};
/// Of what nodes of one mesh have, at those of another; `from_of` says which triangle of the one
/// each of the other's is, kNoTriangle where there is none, and nothing.
std::vector<glm::vec3> at_other_nodes(const NodesOf& from,
                                      const std::vector<glm::vec3>& at_nodes,
                                      const NodesOf& to,
                                      std::span<const std::uint32_t> from_of) {
    const std::vector<glm::vec3> at_points = from.nodes.at_points(at_nodes);
    std::vector<glm::vec3> values(to.nodes.size(), glm::vec3(0.0f));
    parallel_for(values.size(), 2048, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t triangle = to.nodes.points.within[to.nodes.point_of[i]];
            if (from_of[triangle] == kNoTriangle) continue;
            const glm::uvec3 c = to.mesh.triangles[triangle];
            const glm::vec3 a = to.mesh.positions_mm[c.x];
            const glm::vec3 e = to.mesh.positions_mm[c.y] - a;
            const glm::vec3 f = to.mesh.positions_mm[c.z] - a;
            const glm::vec3 p = to.nodes.position_mm(i) - a;
            const float ee = glm::dot(e, e), ef = glm::dot(e, f), ff = glm::dot(f, f);
            const float all = ee * ff - ef * ef;
            if (!(all > 0.0f)) continue;
            const glm::vec2 at((ff * glm::dot(p, e) - ef * glm::dot(p, f)) / all,
                               (ee * glm::dot(p, f) - ef * glm::dot(p, e)) / all);
            for (const auto& share : from.nodes.points.around(from.mesh, from_of[triangle], at)) {
                values[i] += share.weight * at_points[share.index];
            }
        }
    });
    return values;
}

}  // namespace

float shared_reach_mm(float reach_mm) {
    constexpr float kOfAnOctave = 4.0f;
    if (!(reach_mm > 0.0f)) return reach_mm;
    return std::exp2(std::ceil(kOfAnOctave * std::log2(reach_mm)) / kOfAnOctave);
}

SubsurfaceTransport solve_transport(const Mesh& product,
                                    const Tracer& tracer,
                                    std::size_t part,
                                    float reach_mm,
                                    const TransportDetail& detail,
                                    const Progress& progress,
                                    float sheet_mm) {
    SubsurfaceTransport transport;
    transport.part = part;
    transport.reach_mm = reach_mm;
    transport.sheet_mm = sheet_mm;
    take_part(product, transport);
    const double within = std::numbers::pi * static_cast<double>(reach_mm * reach_mm);
    double cell_mm2 = kCellsCrossed * within / detail.neighbours;
    // What comes through a sheet is as fine as it is thin, which takes two nodes to tell
    const auto thin = sheet_mm > 0.0f ? std::optional(sheet_mm)
                                      : thinnest_slab_mm(tracer, product, part, reach_mm);
    if (thin) {
        const double own = 0.5 * static_cast<double>(*thin);
        cell_mm2 = std::clamp(own * own, cell_mm2 / kMoreForSlabs, cell_mm2);
    }
    // What is nearer than nodes is gathered over fragments, which takes long over centimetres
    constexpr double kCoarsest_mm2 = 16.0, kMoreForWide = 2.0;
    cell_mm2 = std::max(std::min(cell_mm2, kCoarsest_mm2), cell_mm2 / kMoreForWide);
    cell_mm2 = std::max(cell_mm2, kCellsCrossed * area_of(transport.mesh) / kMostNodes);
    transport.near_mm = static_cast<float>(kNearCells * std::sqrt(cell_mm2));
    transport.exchange = blocked_directions(transport.mesh,
                                            tracer,
                                            exchange_nodes(transport.mesh, std::sqrt(cell_mm2)),
                                            kPlaceSkyRays,
                                            progress);
    transport.area_mm2 = node_areas_mm2(transport.mesh, transport.exchange.nodes);
    // Else the edge of a shadow would lie where nodes do
    transport.exchange.lamp_origins_mm =
        ray_origins_mm(transport.mesh, transport.exchange.nodes, transport.area_mm2, kLampRays);
    find_slabs(tracer, product, transport);
    find_others(tracer, detail, transport, progress);
    return transport;
}

LeavingLight leaving_at_nodes(const SubsurfaceTransport& transport,
                              const SubsurfaceKernel& kernel,
                              std::span<const glm::vec3> entering,
                              const Progress& progress) {
    std::vector<glm::vec3> power(entering.size());
    for (std::size_t i = 0; i < power.size(); ++i) power[i] = transport.area_mm2[i] * entering[i];
    LeavingLight leaving{std::vector<glm::vec3>(entering.size()),
                         std::vector<glm::vec3>(entering.size()),
                         std::vector<glm::vec3>(entering.size())};
    const NodeLists own{transport.first, transport.other, transport.code};
    const NodeLists behind{transport.through_first, transport.through, transport.through_code};
    parallel_for(entering.size(), 512, [&](std::size_t begin, std::size_t end) {
        progress.check_stop();
        for (std::size_t i = begin; i < end; ++i) {
            if (transport.slab_of[i] != SubsurfaceTransport::kDeep) {
                const SlabKernel& slab = kernel.slabs[transport.slab_of[i]];
                const float bend = slab_bend(transport.curvature_per_mm[i], slab.thickness_mm);
                const glm::vec3 far = slab.far_share + bend * slab.through_share;
                leaving.near_share[i] = slab.near_share;
                leaving.even_share[i] = slab.near_share + far;
                leaving.from_afar[i] =
                    far * mean_of(own, i, transport.area_mm2, slab.far_per_mm2, entering) +
                    (1.0f - bend) * slab.through_share *
                        mean_of(behind, i, transport.area_mm2, slab.through_per_mm2, entering);
                continue;
            }
            const BentShares shares = shares_at(kernel, transport.curvature_per_mm[i]);
            glm::vec3 sum(0.0f), all(0.0f), anywhere(0.0f);
            float area_mm2 = 0.0f;
            for (std::size_t k = transport.first[i]; k < transport.first[i + 1]; ++k) {
                const std::uint16_t code = transport.code[k];
                const std::uint32_t j = transport.other[k];
                const glm::vec3 weight = glm::max(
                    kernel.far_per_mm2[code] + shares.bend_per_mm * kernel.bent_per_mm2[code],
                    glm::vec3(0.0f));
                sum += weight * power[j];
                all += transport.area_mm2[j] * weight;
                anywhere += power[j];
                area_mm2 += transport.area_mm2[j];
            }
            leaving.from_afar[i] = shares.far * glm::mix(sum / glm::max(all, glm::vec3(1e-20f)),
                                                         anywhere / std::max(area_mm2, 1e-20f),
                                                         shares.anywhere);
            leaving.near_share[i] = shares.near;
            leaving.even_share[i] = shares.near + shares.far;
        }
    });
    return leaving;
}

std::vector<glm::vec3> at_part_nodes(const Mesh& product,
                                     const ExchangeNodes& nodes,
                                     const std::vector<glm::vec3>& at_nodes,
                                     const SubsurfaceTransport& transport) {
    std::vector<std::uint32_t> of_product(transport.mesh.triangles.size(), kNoTriangle);
    for (std::size_t t = 0; t < transport.place_of.size(); ++t) {
        if (transport.place_of[t] != kNoTriangle) {
            of_product[transport.place_of[t]] = static_cast<std::uint32_t>(t);
        }
    }
    return at_other_nodes(
        {product, nodes}, at_nodes, {transport.mesh, transport.exchange.nodes}, of_product);
}

std::vector<glm::vec3> from_part_nodes(const SubsurfaceTransport& transport,
                                       const std::vector<glm::vec3>& at_nodes,
                                       const Mesh& product,
                                       const ExchangeNodes& nodes) {
    return at_other_nodes(
        {transport.mesh, transport.exchange.nodes}, at_nodes, {product, nodes}, transport.place_of);
}

std::shared_ptr<const SubsurfaceTransport> SharedTransports::of(const Mesh& product,
                                                                const Tracer& tracer,
                                                                std::size_t part,
                                                                float reach_mm,
                                                                const TransportDetail& detail,
                                                                const Progress& progress,
                                                                float sheet_mm) {
    const std::scoped_lock lock(mutex_);
    Made& made = of_part_[part];
    if (!made.transport || made.transport->reach_mm != reach_mm ||
        made.transport->sheet_mm != sheet_mm || made.detail != detail) {
        made = {detail,
                std::make_shared<const SubsurfaceTransport>(
                    solve_transport(product, tracer, part, reach_mm, detail, progress, sheet_mm))};
    }
    return made.transport;
}

}  // namespace livery
