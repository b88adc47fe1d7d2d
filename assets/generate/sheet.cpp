#include "sheet.h"

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge undirected(std::uint32_t a, std::uint32_t b) { return a < b ? Edge(a, b) : Edge(b, a); }

LimitVertex between(const LimitVertex& a, const LimitVertex& b, double t) {
    return {glm::mix(a.position, b.position, t),
            glm::normalize(glm::mix(a.normal, b.normal, t)),
            glm::mix(a.parameters, b.parameters, t)};
}

/// Edges at these vertices that separate panels or end the sheet.
std::set<Edge> border_edges(const Sheet& sheet, const std::vector<bool>& at_vertex) {
    std::map<Edge, std::pair<int, int>> sides;  // panel, count; count 3: panels differ
    for (const auto& t : sheet.triangles) {
        const auto& c = t.corners;
        if (!at_vertex[c.x] && !at_vertex[c.y] && !at_vertex[c.z]) continue;
        for (int k = 0; k < 3; ++k) {
            const auto edge = undirected(t.corners[k], t.corners[(k + 1) % 3]);
            auto [place, is_new] = sides.try_emplace(edge, t.panel, 1);
            if (!is_new) place->second.second = place->second.first == t.panel ? 2 : 3;
        }
    }
    std::set<Edge> borders;
    for (const auto& [edge, side] : sides) {
        if (!at_vertex[edge.first] && !at_vertex[edge.second]) continue;
        if (side.second != 2) borders.insert(edge);
    }
    return borders;
}

/// Moves vertices that lie close to the curve onto it.
void snap(Sheet& sheet, std::vector<double>& value, const std::vector<bool>& masked) {
    constexpr double kReach = 0.28;  // of an edge
    const auto crosses = [&](std::uint32_t a, std::uint32_t b) {
        return value[a] * value[b] < 0.0;
    };
    std::vector<bool> beside_curve(sheet.vertices.size(), false);
    for (std::size_t k = 0; k < sheet.triangles.size(); ++k) {
        if (!masked[k]) continue;
        const auto& c = sheet.triangles[k].corners;
        for (int e = 0; e < 3; ++e) {
            const auto a = c[e], b = c[(e + 1) % 3];
            if (crosses(a, b)) beside_curve[a] = beside_curve[b] = true;
        }
    }
    const auto borders = border_edges(sheet, beside_curve);
    std::set<std::uint32_t> on_border;
    for (const auto& edge : borders) {
        on_border.insert(edge.first);
        on_border.insert(edge.second);
    }
    struct Move {
        double t = std::numeric_limits<double>::max();
        std::uint32_t toward = 0;
    };
    std::map<std::uint32_t, Move> moves;
    const auto consider = [&](std::uint32_t a, std::uint32_t b) {
        const double t = value[a] / (value[a] - value[b]);
        if (t > kReach) return;
        if (on_border.contains(a) && !borders.contains(undirected(a, b))) return;
        auto& move = moves[a];
        if (t < move.t || (t == move.t && b < move.toward)) move = {t, b};
    };
    for (std::size_t k = 0; k < sheet.triangles.size(); ++k) {
        if (!masked[k]) continue;
        const auto& c = sheet.triangles[k].corners;
        for (int e = 0; e < 3; ++e) {
            const auto a = c[e], b = c[(e + 1) % 3];
            if (crosses(a, b)) {
                consider(a, b);
                consider(b, a);
            }
        }
    }
    const auto before = sheet.vertices;
    for (const auto& [vertex, move] : moves) {
        sheet.vertices[vertex] = between(before[vertex], before[move.toward], move.t);
        value[vertex] = 0.0;
    }
}

}  // namespace

Sheet half_sheet(const LimitMesh& mesh) {
    constexpr double kOnPlane_mm = 1e-6;
    Sheet sheet;
    std::map<int, std::uint32_t> place;
    for (const auto& quad : mesh.quads) {
        double z = 0.0;
        for (int k = 0; k < 4; ++k) {
            z += mesh.vertices[static_cast<std::size_t>(quad.corners[k])].position.z;
        }
        if (z < 0.0) continue;
        glm::uvec4 corner(0);
        for (int k = 0; k < 4; ++k) {
            const auto [entry, is_new] =
                place.try_emplace(quad.corners[k], static_cast<std::uint32_t>(place.size()));
            if (is_new) {
                auto vertex = mesh.vertices[static_cast<std::size_t>(quad.corners[k])];
                if (std::abs(vertex.position.z) < kOnPlane_mm) {
                    vertex.position.z = 0.0;
                    vertex.normal.z = 0.0;
                    vertex.normal = glm::normalize(vertex.normal);
                }
                sheet.vertices.push_back(vertex);
            }
            corner[k] = entry->second;
        }
        const auto at = [&](int k) { return sheet.vertices[corner[k]].position; };
        const bool first = glm::distance(at(0), at(2)) <= glm::distance(at(1), at(3));
        if (first) {
            sheet.triangles.push_back({{corner[0], corner[1], corner[2]}, 0, quad.region});
            sheet.triangles.push_back({{corner[0], corner[2], corner[3]}, 0, quad.region});
        } else {
            sheet.triangles.push_back({{corner[0], corner[1], corner[3]}, 0, quad.region});
            sheet.triangles.push_back({{corner[1], corner[2], corner[3]}, 0, quad.region});
        }
    }
    return sheet;
}

void cut(Sheet& sheet, const CutFunction& f, const TriangleMask& mask, const Relabel& relabel) {
    std::vector<bool> masked(sheet.triangles.size());
    std::vector<double> value(sheet.vertices.size(), 0.0);
    std::vector<bool> known(sheet.vertices.size(), false);
    for (std::size_t k = 0; k < sheet.triangles.size(); ++k) {
        masked[k] = mask(sheet.triangles[k]);
        if (!masked[k]) continue;
        for (int e = 0; e < 3; ++e) {
            const auto v = sheet.triangles[k].corners[e];
            if (!known[v]) value[v] = f(sheet.vertices[v]);
            known[v] = true;
        }
    }
    snap(sheet, value, masked);

    std::map<Edge, std::uint32_t> crossings;
    const auto crossing = [&](std::uint32_t a, std::uint32_t b) {
        const auto edge = undirected(a, b);
        auto [place, is_new] = crossings.try_emplace(edge, 0);
        if (is_new) {
            const double va = value[edge.first], vb = value[edge.second];
            place->second = static_cast<std::uint32_t>(sheet.vertices.size());
            sheet.vertices.push_back(
                between(sheet.vertices[edge.first], sheet.vertices[edge.second], va / (va - vb)));
        }
        return place->second;
    };
    // An edge between a masked and an unmasked triangle is split in both, so that no gap opens.
    std::vector<SheetTriangle> result;
    const auto split_edges = [&](const SheetTriangle& t) {
        int count = 0;
        for (int e = 0; e < 3; ++e) {
            count += value[t.corners[e]] * value[t.corners[(e + 1) % 3]] < 0.0 ? 1 : 0;
        }
        return count;
    };
    for (std::size_t k = 0; k < sheet.triangles.size(); ++k) {
        const auto t = sheet.triangles[k];
        const auto inside = [&](double v0, double v1, double v2) {
            return masked[k] && v0 + v1 + v2 < 0.0;
        };
        const auto emit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, bool is_inside) {
            const bool moves = masked[k] && is_inside;
            result.push_back({{a, b, c}, moves ? relabel(t.panel) : t.panel, t.region});
        };
        const auto val = [&](int e) { return value[t.corners[e % 3]]; };
        const int splits = split_edges(t);
        if (splits == 0) {
            bool in = inside(val(0), val(1), val(2));
            if (masked[k] && val(0) == 0.0 && val(1) == 0.0 && val(2) == 0.0) {
                const auto& v = sheet.vertices;
                in = f(between(between(v[t.corners[0]], v[t.corners[1]], 0.5),
                               v[t.corners[2]],
                               1.0 / 3.0)) < 0.0;
            }
            emit(t.corners[0], t.corners[1], t.corners[2], in);
        } else if (splits == 1) {
            // One corner lies on the curve.
            int e = 0;
            while (!(val(e) * val(e + 1) < 0.0)) ++e;
            const auto a = t.corners[e], b = t.corners[(e + 1) % 3], c = t.corners[(e + 2) % 3];
            const auto m = crossing(a, b);
            emit(a, m, c, val(e) < 0.0);
            emit(m, b, c, val(e + 1) < 0.0);
        } else {
            // One corner is alone on its side.
            int e = 0;
            while (!(val(e) * val(e + 1) < 0.0 && val(e) * val(e + 2) < 0.0)) ++e;
            const auto a = t.corners[e], b = t.corners[(e + 1) % 3], c = t.corners[(e + 2) % 3];
            const auto ab = crossing(a, b), ca = crossing(a, c);
            emit(a, ab, ca, val(e) < 0.0);
            const auto at = [&](std::uint32_t v) { return sheet.vertices[v].position; };
            if (glm::distance(at(ab), at(c)) <= glm::distance(at(b), at(ca))) {
                emit(ab, b, c, val(e) > 0.0);
                emit(ab, c, ca, val(e) > 0.0);
            } else {
                emit(ab, b, ca, val(e) > 0.0);
                emit(b, c, ca, val(e) > 0.0);
            }
        }
    }
    sheet.triangles = std::move(result);
}

}  // namespace livery::assets
