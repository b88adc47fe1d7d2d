#include "soundness.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace livery {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;

Point to_cgal(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

glm::dvec3 cross_of(const Solids& solids, const glm::uvec3& t) {
    const auto& a = solids.points_mm[t.x];
    return glm::cross(solids.points_mm[t.y] - a, solids.points_mm[t.z] - a);
}

glm::dvec3 middle_of(const Solids& solids, const glm::uvec3& t) {
    return (solids.points_mm[t.x] + solids.points_mm[t.y] + solids.points_mm[t.z]) / 3.0;
}

void find_shells(Solids& solids) {
    // Vertices of two parts or two shells may coincide; edges within a part join a shell.
    std::vector<std::uint32_t> parent(solids.triangles.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto find = [&](std::uint32_t k) {
        while (parent[k] != k) k = parent[k] = parent[parent[k]];
        return k;
    };
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> first_of_edge;
    for (std::uint32_t t = 0; t < solids.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const auto a = solids.triangles[t][k], b = solids.triangles[t][(k + 1) % 3];
            const auto [place, is_new] = first_of_edge.try_emplace(
                {static_cast<std::uint32_t>(solids.part[t]), std::min(a, b), std::max(a, b)}, t);
            if (!is_new) parent[find(t)] = find(place->second);
        }
    }
    std::map<std::uint32_t, int> shells;
    for (std::uint32_t t = 0; t < solids.triangles.size(); ++t) {
        const auto place = shells.try_emplace(find(t), static_cast<int>(shells.size())).first;
        solids.shell.push_back(place->second);
    }
    solids.shells = static_cast<int>(shells.size());
}

using TriangleBox = CGAL::Box_intersection_d::
    Box_with_handle_d<double, 3, std::vector<std::uint32_t>::const_iterator>;

/// Calls `visit` for each pair of triangles whose boxes, `margin_mm` larger, overlap.
template <typename Visit>
void for_close_pairs(const Solids& solids, double margin_mm, Visit&& visit) {
    std::vector<std::uint32_t> index(solids.triangles.size());
    std::iota(index.begin(), index.end(), 0u);
    std::vector<TriangleBox> boxes;
    for (auto k = index.cbegin(); k != index.cend(); ++k) {
        const auto& t = solids.triangles[*k];
        auto low = solids.points_mm[t.x], high = low;
        for (int c = 1; c < 3; ++c) {
            low = glm::min(low, solids.points_mm[t[c]]);
            high = glm::max(high, solids.points_mm[t[c]]);
        }
        std::array<double, 3> lo{}, hi{};
        for (std::size_t d = 0; d < 3; ++d) {
            lo[d] = low[static_cast<int>(d)] - margin_mm;
            hi[d] = high[static_cast<int>(d)] + margin_mm;
        }
        boxes.emplace_back(lo.data(), hi.data(), k);
    }
    CGAL::box_self_intersection_d(
        boxes.begin(), boxes.end(), [&](const TriangleBox& a, const TriangleBox& b) {
            visit(*a.handle(), *b.handle());
        });
}

/// Corners of `t` in an order that starts with those that `other` has too; how many these are.
int shared_first(const glm::uvec3& t,
                 const glm::uvec3& other,
                 std::array<std::uint32_t, 3>& order) {
    const auto is_shared = [&](std::uint32_t v) {
        return v == other.x || v == other.y || v == other.z;
    };
    int shared = 0;
    std::size_t place = 0;
    for (int k = 0; k < 3; ++k) shared += is_shared(t[k]) ? 1 : 0;
    for (const bool wanted : {true, false}) {
        for (int k = 0; k < 3; ++k) {
            if (is_shared(t[k]) == wanted) order[place++] = t[k];
        }
    }
    return shared;
}

bool do_cross(const Solids& solids, const glm::uvec3& s, const glm::uvec3& t) {
    std::array<std::uint32_t, 3> a{}, b{};
    const int shared = shared_first(s, t, a);
    shared_first(t, s, b);
    const auto at = [&](std::uint32_t v) { return to_cgal(solids.points_mm[v]); };
    const Triangle first(at(a[0]), at(a[1]), at(a[2])), second(at(b[0]), at(b[1]), at(b[2]));
    switch (shared) {
        case 0:
            return CGAL::do_intersect(first, second);
        case 1:
            return CGAL::do_intersect(first, Segment(at(b[1]), at(b[2]))) ||
                   CGAL::do_intersect(second, Segment(at(a[1]), at(a[2])));
        case 2:
            return CGAL::coplanar(at(a[0]), at(a[1]), at(a[2]), at(b[2])) &&
                   CGAL::coplanar_orientation(at(a[0]), at(a[1]), at(a[2]), at(b[2])) ==
                       CGAL::POSITIVE;
        default:
            return true;
    }
}

Fault fault_between(const Solids& solids, std::uint32_t a, std::uint32_t b) {
    return {solids.part[a],
            solids.part[b],
            middle_of(solids, solids.triangles[a]),
            solids.shell[a] == solids.shell[b]};
}

/// Whether the triangles overlap by more than their rims, seen along the axis that the first faces
/// most.
bool overlap_along_normal(const Solids& solids, const glm::uvec3& s, const glm::uvec3& t) {
    constexpr double kShrunk = 0.95;
    const auto n = glm::abs(cross_of(solids, s));
    const int axis = n.x > n.y && n.x > n.z ? 0 : (n.y > n.z ? 1 : 2);
    const auto flat = [&](const glm::uvec3& corners) {
        const auto middle = middle_of(solids, corners);
        std::array<Kernel::Point_2, 3> p;
        for (int k = 0; k < 3; ++k) {
            const auto q = middle + (solids.points_mm[corners[k]] - middle) * kShrunk;
            p[static_cast<std::size_t>(k)] = {q[(axis + 1) % 3], q[(axis + 2) % 3]};
        }
        return Kernel::Triangle_2(p[0], p[1], p[2]);
    };
    return CGAL::do_intersect(flat(s), flat(t));
}

}  // namespace

Solids solids_of(const Mesh& mesh) {
    Solids solids;
    for (const auto& part : mesh.parts) solids.part_names.push_back(part.name);
    std::map<std::array<float, 3>, std::uint32_t> place_of;
    std::vector<std::uint32_t> welded;
    for (const auto& p : mesh.positions_mm) {
        // -0 is 0.
        const auto [place, is_new] =
            place_of.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f},
                                 static_cast<std::uint32_t>(solids.points_mm.size()));
        if (is_new) solids.points_mm.emplace_back(p);
        welded.push_back(place->second);
    }
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        const auto& t = mesh.triangles[k];
        solids.triangles.emplace_back(welded[t.x], welded[t.y], welded[t.z]);
        solids.part.push_back(mesh.triangle_part[k]);
        const auto cross = cross_of(solids, solids.triangles.back());
        glm::dvec3 dots(0.0);
        for (int c = 0; c < 3; ++c) {
            dots[c] = glm::dot(cross, glm::dvec3(mesh.normals[t[c]])) / glm::length(cross);
        }
        solids.least_normal_dot.push_back(dots);
    }
    find_shells(solids);
    return solids;
}

std::string to_text(const Solids& solids, const std::vector<Fault>& faults) {
    constexpr std::size_t kMost = 12;
    std::string text = std::to_string(faults.size()) + " faults";
    for (std::size_t k = 0; k < std::min(faults.size(), kMost); ++k) {
        const auto& fault = faults[k];
        const auto name = [&](int part) {
            return solids.part_names[static_cast<std::size_t>(part)];
        };
        text += "\n  " + name(fault.part_a) + " with " + name(fault.part_b) + " at " +
                std::to_string(fault.at_mm.x) + ", " + std::to_string(fault.at_mm.y) + ", " +
                std::to_string(fault.at_mm.z) + (fault.one_shell ? " in one shell" : "");
    }
    return text;
}

std::vector<Fault> open_edges(const Solids& solids) {
    std::map<std::array<std::uint32_t, 3>, std::pair<int, std::uint32_t>> directed;
    for (std::uint32_t t = 0; t < solids.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            auto& use = directed[{static_cast<std::uint32_t>(solids.part[t]),
                                  solids.triangles[t][k],
                                  solids.triangles[t][(k + 1) % 3]}];
            ++use.first;
            use.second = t;
        }
    }
    std::vector<Fault> faults;
    for (const auto& [edge, use] : directed) {
        const auto back = directed.find({edge[0], edge[2], edge[1]});
        if (use.first == 1 && back != directed.end() && back->second.first == 1) continue;
        faults.push_back(fault_between(solids, use.second, use.second));
    }
    return faults;
}

std::vector<Fault> inside_out_shells(const Solids& solids) {
    std::vector<double> volume(static_cast<std::size_t>(solids.shells), 0.0);
    std::vector<std::uint32_t> member(volume.size(), 0);
    for (std::uint32_t t = 0; t < solids.triangles.size(); ++t) {
        const auto shell = static_cast<std::size_t>(solids.shell[t]);
        const auto& c = solids.triangles[t];
        // From a corner of the shell, so that thin solids far away keep their figures.
        if (volume[shell] == 0.0 && member[shell] == 0) member[shell] = t;
        const auto& origin = solids.points_mm[solids.triangles[member[shell]].x];
        volume[shell] +=
            glm::dot(solids.points_mm[c.x] - origin,
                     glm::cross(solids.points_mm[c.y] - origin, solids.points_mm[c.z] - origin)) /
            6.0;
    }
    std::vector<Fault> faults;
    for (std::size_t shell = 0; shell < volume.size(); ++shell) {
        if (volume[shell] <= 0.0) {
            faults.push_back(fault_between(solids, member[shell], member[shell]));
        }
    }
    return faults;
}

std::vector<Fault> slivers(const Solids& solids, double height_mm) {
    std::vector<Fault> faults;
    for (std::uint32_t t = 0; t < solids.triangles.size(); ++t) {
        const auto& c = solids.triangles[t];
        double longest = 0.0;
        for (int k = 0; k < 3; ++k) {
            longest = std::max(
                longest, glm::distance(solids.points_mm[c[k]], solids.points_mm[c[(k + 1) % 3]]));
        }
        if (!(glm::length(cross_of(solids, c)) >= height_mm * longest)) {
            faults.push_back(fault_between(solids, t, t));
        }
    }
    return faults;
}

std::vector<Fault> inverted_faces(const Solids& solids) {
    std::vector<Fault> faults;
    for (std::uint32_t t = 0; t < solids.triangles.size(); ++t) {
        const auto& dots = solids.least_normal_dot[t];
        if (!(std::min({dots.x, dots.y, dots.z}) > 0.0)) {
            faults.push_back(fault_between(solids, t, t));
        }
    }
    return faults;
}

std::vector<Fault> crossings(const Solids& solids) {
    std::vector<Fault> faults;
    for_close_pairs(solids, 0.0, [&](std::uint32_t a, std::uint32_t b) {
        if (do_cross(solids, solids.triangles[a], solids.triangles[b])) {
            faults.push_back(fault_between(solids, a, b));
        }
    });
    return faults;
}

std::vector<Fault> coincident_faces(const Solids& solids, double distance_mm) {
    constexpr double kParallel_cos = 0.9986;  // 3 degrees
    std::vector<glm::dvec3> normals;
    for (const auto& t : solids.triangles) {
        normals.push_back(glm::normalize(cross_of(solids, t)));
    }
    std::vector<Fault> faults;
    for_close_pairs(solids, 0.5 * distance_mm, [&](std::uint32_t a, std::uint32_t b) {
        if (solids.part[a] == solids.part[b]) return;
        if (glm::dot(normals[a], normals[b]) < kParallel_cos) return;
        const auto& s = solids.triangles[a];
        const auto& t = solids.triangles[b];
        const auto apart = middle_of(solids, t) - middle_of(solids, s);
        if (std::abs(glm::dot(apart, normals[a])) > distance_mm) return;
        if (overlap_along_normal(solids, s, t)) faults.push_back(fault_between(solids, a, b));
    });
    return faults;
}

}  // namespace livery
