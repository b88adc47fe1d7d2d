#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

#include "sheet.h"

namespace livery::assets {

namespace {

using VertexOfPanel = std::pair<std::uint32_t, int>;

struct Border {
    std::uint32_t from, to;  // the panel on the left
    int panel, neighbour, region;
};

bool on_centre(const LimitVertex& v) { return v.position.z == 0.0; }

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

/// Builds the panels of one sheet into parts.
class PanelBuilder {
  public:
    PanelBuilder(const Sheet& sheet,
                 const std::vector<PanelStyle>& styles,
                 const ChartFunction& chart,
                 std::vector<PartMesh>& parts)
        : sheet_(sheet),
          styles_(styles),
          chart_(chart),
          parts_(parts),
          borders_(borders_of(sheet)) {
        find_mitres();
        find_steps();
    }

    void add_faces();
    void add_wall(const Border& border);
    void add_joint(const Border& border, PartMesh& joints);
    OpenEdge open_edge(const Border& border) const;
    const std::vector<Border>& borders() const { return borders_; }

  private:
    const PanelStyle& style_of(int panel) const { return styles_[static_cast<std::size_t>(panel)]; }
    double gap_between(const Border& border) const {
        return std::min(style_of(border.panel).gap_mm, style_of(border.neighbour).gap_mm);
    }
    glm::dvec3 mitre(std::uint32_t v, int panel) const {
        const auto found = mitre_.find({v, panel});
        return found == mitre_.end() ? glm::dvec3(0.0) : found->second;
    }
    double step(std::uint32_t v, int panel) const {
        const auto found = step_mm_.find({v, panel});
        return found == step_mm_.end() ? 0.0 : found->second;
    }
    glm::dvec3 place(std::uint32_t v, int panel, double depth_mm) const {
        const auto& vertex = sheet_.vertices[v];
        if (style_of(panel).relief_mm) depth_mm += style_of(panel).relief_mm(vertex);
        return vertex.position - vertex.normal * depth_mm + mitre(v, panel) * step(v, panel);
    }
    glm::dvec2 uv(std::uint32_t v, int region) const {
        return chart_(sheet_.vertices[v], region) / kUvUnit_mm + glm::dvec2(0.5);
    }
    double length_of(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(sheet_.vertices[a].position, sheet_.vertices[b].position);
    }
    /// The deepest that an edge may be turned in: over tight curvature its lower end would cross.
    double depth_limit_mm(const Border& border) const {
        const double turn =
            glm::distance(sheet_.vertices[border.from].normal, sheet_.vertices[border.to].normal);
        return 0.5 * length_of(border.from, border.to) / std::max(turn, 1e-9);
    }
    void find_mitres();
    void find_steps();

    const Sheet& sheet_;
    const std::vector<PanelStyle>& styles_;
    const ChartFunction& chart_;
    std::vector<PartMesh>& parts_;
    std::vector<Border> borders_;
    /// For each vertex of a panel's joints the step in the skin into the panel that moves all of
    /// its joints there by 1, at most 2 long.
    std::map<VertexOfPanel, glm::dvec3> mitre_;
    std::map<VertexOfPanel, double> step_mm_;  ///< how far it steps back, half the gap
};

void PanelBuilder::find_mitres() {
    std::map<VertexOfPanel, int> count;
    for (const auto& border : borders_) {
        if (border.neighbour == kNoPanel) continue;
        const auto along = glm::normalize(sheet_.vertices[border.to].position -
                                          sheet_.vertices[border.from].position);
        for (const auto v : {border.from, border.to}) {
            mitre_[{v, border.panel}] += glm::cross(sheet_.vertices[v].normal, along);
            ++count[{v, border.panel}];
        }
    }
    for (auto& [key, direction] : mitre_) {
        if (on_centre(sheet_.vertices[key.first])) direction.z = 0.0;
        const double length = glm::length(direction);
        direction = length > 1e-9 ? direction / length * std::min(2.0, count[key] / length)
                                  : glm::dvec3(0.0);
    }
}

void PanelBuilder::find_steps() {
    for (const auto& border : borders_) {
        if (border.neighbour == kNoPanel) continue;
        for (const auto v : {border.from, border.to}) {
            auto& step = step_mm_[{v, border.panel}];
            step = std::max(step, 0.5 * gap_between(border));
        }
    }
    // Short edges, as in a panel's tip, bound the step, so that no triangle flips.
    constexpr double kOfShortestEdge = 0.35;
    for (const auto& t : sheet_.triangles) {
        for (int k = 0; k < 3; ++k) {
            const auto a = t.corners[k], b = t.corners[(k + 1) % 3];
            for (const auto v : {a, b}) {
                const auto found = step_mm_.find({v, t.panel});
                if (found == step_mm_.end()) continue;
                found->second = std::min(found->second, kOfShortestEdge * length_of(a, b));
            }
        }
    }
}

void PanelBuilder::add_faces() {
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> emitted;  // vertex, panel, region
    std::map<VertexOfPanel, glm::dvec3> relief_normals;
    for (const auto& t : sheet_.triangles) {
        if (t.panel == kNoPanel) continue;
        const auto& style = style_of(t.panel);
        auto& part = parts_[static_cast<std::size_t>(style.part)];
        glm::uvec3 corner(0);
        for (int k = 0; k < 3; ++k) {
            const auto v = t.corners[k];
            const auto [entry, is_new] = emitted.try_emplace(
                {v, static_cast<std::uint32_t>(t.panel), static_cast<std::uint32_t>(t.region)}, 0u);
            if (is_new) {
                entry->second = part.add_vertex(
                    place(v, t.panel, style.inset_mm), sheet_.vertices[v].normal, uv(v, t.region));
            }
            corner[k] = entry->second;
        }
        part.add_triangle(corner.x, corner.y, corner.z);
        if (style.relief_mm) {
            const auto at = [&](int k) { return part.positions_mm[corner[k]]; };
            const auto area = glm::cross(at(1) - at(0), at(2) - at(0));
            for (int k = 0; k < 3; ++k) {
                relief_normals[{t.corners[k], t.panel}] += area;
            }
        }
    }
    for (const auto& [key, vertex] : emitted) {
        const auto found = relief_normals.find({key[0], static_cast<int>(key[1])});
        if (found == relief_normals.end() || !(glm::length(found->second) > 0.0)) continue;
        auto& part = parts_[static_cast<std::size_t>(style_of(found->first.second).part)];
        auto normal = found->second;
        if (on_centre(sheet_.vertices[key[0]])) normal.z = 0.0;
        part.normals[vertex] = glm::normalize(normal);
    }
}

void PanelBuilder::add_wall(const Border& border) {
    const auto& style = style_of(border.panel);
    const double depth_mm = std::min(style.wall_mm, depth_limit_mm(border) - style.inset_mm);
    if (depth_mm <= 0.0) return;
    auto& part = parts_[static_cast<std::size_t>(style.part)];
    const auto along =
        glm::normalize(sheet_.vertices[border.to].position - sheet_.vertices[border.from].position);
    const auto upright = [&](std::uint32_t v) {
        // Smooth along the edge, but not around its corners.
        const auto own = -glm::cross(sheet_.vertices[v].normal, along);
        const auto smooth = -mitre(v, border.panel);
        const bool is_corner = !(glm::dot(own, smooth) > 0.9 * glm::length(smooth));
        const auto out = glm::normalize(is_corner ? own : smooth);
        return std::array<std::uint32_t, 2>{
            part.add_vertex(place(v, border.panel, style.inset_mm), out, uv(v, border.region)),
            part.add_vertex(
                place(v, border.panel, style.inset_mm + depth_mm), out, uv(v, border.region))};
    };
    const auto a = upright(border.from), b = upright(border.to);
    part.add_quad(a[0], a[1], b[1], b[0]);
}

void PanelBuilder::add_joint(const Border& border, PartMesh& joints) {
    constexpr double kBelow_mm = 0.45;
    constexpr double kOverGap = 2.6;  // reaches below both edges
    // Once a pair of panels.
    if (gap_between(border) <= 0.0 || border.panel > border.neighbour) return;
    const double depth_mm =
        kBelow_mm + std::max(style_of(border.panel).inset_mm, style_of(border.neighbour).inset_mm);
    if (depth_mm > depth_limit_mm(border)) return;
    const auto across = [&](std::uint32_t v) {
        const auto& vertex = sheet_.vertices[v];
        const auto below = vertex.position - vertex.normal * depth_mm;
        const auto side = mitre(v, border.panel) * (kOverGap * step(v, border.panel));
        return std::array<glm::dvec3, 2>{below + side, below - side};
    };
    const auto a = across(border.from), b = across(border.to);
    // In a sharp tip the strip would fold over; the edges' walls close it there.
    const auto& normal = sheet_.vertices[border.from].normal;
    for (const auto k : {0u, 1u}) {
        if (glm::dot(glm::cross(a[1] - a[0], b[k] - a[1 - k]), normal) <= 0.0) return;
        if (glm::dot(glm::cross(b[1] - b[0], b[k] - a[1 - k]), normal) <= 0.0) return;
    }
    const auto vertex = [&](const glm::dvec3& at, std::uint32_t v) {
        return joints.add_vertex(at, sheet_.vertices[v].normal, uv(v, border.region));
    };
    joints.add_quad(vertex(a[0], border.from),
                    vertex(a[1], border.from),
                    vertex(b[1], border.to),
                    vertex(b[0], border.to));
}

OpenEdge PanelBuilder::open_edge(const Border& border) const {
    const auto& style = style_of(border.panel);
    return {place(border.from, border.panel, style.inset_mm),
            place(border.to, border.panel, style.inset_mm),
            style.part,
            border.region};
}

}  // namespace

std::vector<OpenEdge> build_panels(const Sheet& sheet,
                                   const std::vector<PanelStyle>& styles,
                                   const ChartFunction& chart,
                                   int joint_part,
                                   std::vector<PartMesh>& parts) {
    PanelBuilder builder(sheet, styles, chart, parts);
    builder.add_faces();
    std::vector<OpenEdge> open;
    for (const auto& border : builder.borders()) {
        if (border.neighbour == kNoPanel) {
            open.push_back(builder.open_edge(border));
            continue;
        }
        builder.add_wall(border);
        builder.add_joint(border, parts[static_cast<std::size_t>(joint_part)]);
    }
    return open;
}

}  // namespace livery::assets
