#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "sheet.h"

namespace livery::assets {

namespace {

using VertexOfPanel = std::pair<std::uint32_t, int>;

struct Border {
    std::uint32_t from, to;  // the panel on the left
    int panel, neighbour, region;
};

bool on_centre(const LimitVertex& v) {
    return v.position.z == 0.0;
}

std::vector<Border> borders_of(const Sheet& sheet) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> panel_of_edge;
    for (const auto& t : sheet.triangles) {
        for (int k = 0; k < 3; ++k) {
            panel_of_edge[{t.corners[k], t.corners[(k + 1) % 3]}] = t.panel;
        }
    }
    std::vector<Border> borders;
    for (const auto& t : sheet.triangles) {
        if (t.panel == kNoPanel) continue;
        for (int k = 0; k < 3; ++k) {
            const auto a = t.corners[k], b = t.corners[(k + 1) % 3];
            const auto twin = panel_of_edge.find({b, a});
            const bool open = twin == panel_of_edge.end();
            if (open && on_centre(sheet.vertices[a]) && on_centre(sheet.vertices[b])) continue;
            const int neighbour = open ? kNoPanel : twin->second;
            if (neighbour != t.panel) borders.push_back({a, b, t.panel, neighbour, t.region});
        }
    }
    return borders;
}

/// For each border vertex of a panel the unit direction in the skin that points into the panel.
std::map<VertexOfPanel, glm::dvec3> inward_directions(const Sheet& sheet,
                                                      const std::vector<Border>& borders) {
    std::map<VertexOfPanel, glm::dvec3> inward;
    for (const auto& border : borders) {
        const auto along = glm::normalize(sheet.vertices[border.to].position -
                                          sheet.vertices[border.from].position);
        for (const auto v : {border.from, border.to}) {
            inward[{v, border.panel}] += glm::cross(sheet.vertices[v].normal, along);
        }
    }
    for (auto& [key, direction] : inward) {
        if (on_centre(sheet.vertices[key.first])) direction.z = 0.0;
        const double length = glm::length(direction);
        direction = length > 1e-9 ? direction / length : glm::dvec3(0.0);
    }
    return inward;
}

}  // namespace

std::vector<OpenEdge> build_panels(const Sheet& sheet,
                                   const std::vector<PanelStyle>& styles,
                                   const ChartFunction& chart,
                                   int joint_part,
                                   std::vector<PartMesh>& parts) {
    const auto borders = borders_of(sheet);
    const auto inward = inward_directions(sheet, borders);
    std::map<VertexOfPanel, double> gap;
    for (const auto& border : borders) {
        if (border.neighbour == kNoPanel) continue;
        const auto of = [&](int panel) { return styles[static_cast<std::size_t>(panel)].gap_mm; };
        const double width = std::min(of(border.panel), of(border.neighbour));
        for (const auto v : {border.from, border.to}) {
            auto& g = gap[{v, border.panel}];
            g = std::max(g, width);
        }
    }
    const auto style_of = [&](int panel) -> const PanelStyle& {
        return styles[static_cast<std::size_t>(panel)];
    };
    const auto direction_of = [&](std::uint32_t v, int panel) {
        const auto found = inward.find({v, panel});
        return found == inward.end() ? glm::dvec3(0.0) : found->second;
    };
    const auto place = [&](std::uint32_t v, int panel, double depth_mm) {
        const auto& vertex = sheet.vertices[v];
        const auto width = gap.find({v, panel});
        const double shrink = width == gap.end() ? 0.0 : 0.5 * width->second;
        return vertex.position - vertex.normal * depth_mm + direction_of(v, panel) * shrink;
    };
    const auto uv = [&](std::uint32_t v, int region) {
        return chart(sheet.vertices[v], region) / kUvUnit_mm + glm::dvec2(0.5);
    };

    // The panels' faces.
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> emitted;
    for (const auto& t : sheet.triangles) {
        if (t.panel == kNoPanel) continue;
        const auto& style = style_of(t.panel);
        auto& part = parts[static_cast<std::size_t>(style.part)];
        glm::uvec3 corner(0);
        for (int k = 0; k < 3; ++k) {
            const auto v = t.corners[k];
            const auto [entry, is_new] = emitted.try_emplace(
                {v, static_cast<std::uint32_t>(t.panel), static_cast<std::uint32_t>(t.region)}, 0u);
            if (is_new) {
                entry->second = part.add_vertex(
                    place(v, t.panel, style.inset_mm), sheet.vertices[v].normal, uv(v, t.region));
            }
            corner[k] = entry->second;
        }
        part.add_triangle(corner.x, corner.y, corner.z);
    }

    // Turned-in edges, and the dark bottom of the joints.
    constexpr double kJointDepth_mm = 0.45;
    constexpr double kJointReach_mm = 0.22;
    std::map<std::array<std::uint32_t, 3>, std::array<std::uint32_t, 2>> strips;
    std::vector<OpenEdge> open;
    for (const auto& border : borders) {
        const auto& style = style_of(border.panel);
        if (border.neighbour == kNoPanel) {
            open.push_back({place(border.from, border.panel, style.inset_mm),
                            place(border.to, border.panel, style.inset_mm),
                            border.panel});
            continue;
        }
        auto& part = parts[static_cast<std::size_t>(style.part)];
        const auto along = glm::normalize(sheet.vertices[border.to].position -
                                          sheet.vertices[border.from].position);
        const auto wall = [&](std::uint32_t v) {
            // Smooth along the edge, but not around its corners.
            const auto own = -glm::cross(sheet.vertices[v].normal, along);
            const auto smooth = -direction_of(v, border.panel);
            const auto out = glm::normalize(glm::dot(own, smooth) > 0.9 ? smooth : own);
            return std::array<std::uint32_t, 2>{
                part.add_vertex(place(v, border.panel, style.inset_mm), out, uv(v, border.region)),
                part.add_vertex(place(v, border.panel, style.inset_mm + style.wall_mm),
                                out,
                                uv(v, border.region))};
        };
        const auto a = wall(border.from), b = wall(border.to);
        part.add_quad(a[0], a[1], b[1], b[0]);

        const bool has_joint = std::min(style.gap_mm, style_of(border.neighbour).gap_mm) > 0.0 &&
                               border.panel < border.neighbour;
        if (!has_joint) continue;
        auto& joints = parts[static_cast<std::size_t>(joint_part)];
        const double deepest = std::max(style.inset_mm, style_of(border.neighbour).inset_mm);
        const auto strip = [&](std::uint32_t v) {
            const auto [entry, is_new] =
                strips.try_emplace({v,
                                    static_cast<std::uint32_t>(border.panel),
                                    static_cast<std::uint32_t>(border.region)},
                                   std::array<std::uint32_t, 2>{});
            if (!is_new) return entry->second;
            const auto& vertex = sheet.vertices[v];
            const auto side = direction_of(v, border.panel) * kJointReach_mm;
            const auto below = vertex.position - vertex.normal * (deepest + kJointDepth_mm);
            entry->second = {joints.add_vertex(below + side, vertex.normal, uv(v, border.region)),
                             joints.add_vertex(below - side, vertex.normal, uv(v, border.region))};
            return entry->second;
        };
        const auto c = strip(border.from), d = strip(border.to);
        joints.add_quad(c[0], c[1], d[1], d[0]);
    }
    return open;
}

}  // namespace livery::assets
