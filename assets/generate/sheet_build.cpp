#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include <glm/geometric.hpp>

#include "posts.h"
#include "sheet.h"
#include "shell.h"
#include "tidy.h"

namespace livery::assets {

namespace {

constexpr double kSlit_mm = 0.02;    ///< between panels that shall touch
constexpr double kOverlap_mm = 0.1;  ///< a panel's edge reaches this far below a deeper neighbour
constexpr double kJointBelow_mm = 0.1;  ///< the joints' bottom below all panels there
constexpr double kBandStep_mm = 0.01;
constexpr double kLeastThickness = 0.4;  ///< of what it should be, for a joint's band
constexpr double kJointThick_mm = 0.15;
constexpr double kTolerance_mm = 0.06;

double length_between(const Sheet& sheet, std::uint32_t a, std::uint32_t b) {
    return glm::distance(sheet.vertices[a].position, sheet.vertices[b].position);
}

/// For each post on a joint the step in the skin into its piece that moves all of the joints there
/// by 1, at most 2 long.
std::vector<glm::dvec3> mitres(const Sheet& sheet, const Posts& posts, bool at_open_ends) {
    std::vector<glm::dvec3> mitre(posts.vertex.size(), glm::dvec3(0.0));
    std::vector<int> count(posts.vertex.size(), 0);
    for (const auto& border : posts.borders) {
        if ((border.neighbour == kNoPanel) != at_open_ends) continue;
        const auto& from = sheet.vertices[posts.vertex[border.from]];
        const auto& to = sheet.vertices[posts.vertex[border.to]];
        const auto along = glm::normalize(to.position - from.position);
        mitre[border.from] += glm::cross(from.normal, along);
        mitre[border.to] += glm::cross(to.normal, along);
        ++count[border.from];
        ++count[border.to];
    }
    for (std::size_t p = 0; p < mitre.size(); ++p) {
        auto& direction = mitre[p];
        if (posts.on_centre[p]) direction.z = 0.0;
        const double length = glm::length(direction);
        direction =
            length > 1e-9 ? direction / length * std::min(2.0, count[p] / length) : glm::dvec3(0.0);
    }
    return mitre;
}

/// Panels and the band under their joints, thinned where the skin bends too tightly for them.
class PanelBuilder {
  public:
    PanelBuilder(const Sheet& sheet, const std::vector<PanelStyle>& styles)
        : sheet_(sheet),
          styles_(styles),
          panels_(stand_posts(sheet, panel_of_triangle())),
          mitre_(mitres(sheet, panels_, false)),
          inward_(mitre_),
          thickness_(sheet.vertices.size(), 1.0) {
        const auto at_open_ends = mitres(sheet, panels_, true);
        for (std::size_t p = 0; p < inward_.size(); ++p) {
            if (inward_[p] == glm::dvec3(0.0)) inward_[p] = at_open_ends[p];
        }
        find_steps();
        find_depths();
        keep_clear();
        thin_all();
        lay_band();
        thin_all();
        lay_band();  // not where there is no room left
    }

    void add_panels(const ChartFunction& chart, std::vector<PartMesh>& parts) const {
        std::vector<bool> over_band(sheet_.vertices.size(), false);
        for (const auto v : band_.vertex) over_band[v] = true;
        std::vector<PostPlaces> places;
        for (std::uint32_t p = 0; p < panels_.vertex.size(); ++p) {
            const auto& style = style_of(panels_.piece[p]);
            const auto v = panels_.vertex[p];
            // Relief makes a panel thinner than its depth.
            const double of_thickness =
                thickness_[v] * thickness_[v] * (style.relief_mm ? 0.3 : 1.0);
            const double tolerance_mm = over_band[v] ? 0.0 : kTolerance_mm * of_thickness;
            places.push_back({outer(p),
                              inner(p),
                              inward_[p],
                              style.is_coarse ? tolerance_mm : 0.0,
                              tolerance_mm,
                              static_cast<bool>(style.relief_mm)});
        }
        add_shells(sheet_, panels_, places, chart, [&](int panel) -> PartMesh& {
            return parts[static_cast<std::size_t>(style_of(panel).part)];
        });
    }

    void add_joints(const ChartFunction& chart, PartMesh& part) const {
        std::vector<PostPlaces> places;
        for (std::uint32_t p = 0; p < band_.vertex.size(); ++p) {
            const auto v = band_.vertex[p];
            places.push_back({in_band(p, band_top(v)),
                              in_band(p, band_bottom(v)),
                              band_inward_[p],
                              0.0,
                              0.0,
                              true});
        }
        add_shells(sheet_, band_, places, chart, [&](int) -> PartMesh& { return part; });
    }

  private:
    const PanelStyle& style_of(int panel) const { return styles_[static_cast<std::size_t>(panel)]; }
    double gap_mm(const PieceBorder& border) const {
        return std::min(style_of(panels_.piece[border.from]).gap_mm,
                        style_of(border.neighbour).gap_mm);
    }
    std::vector<int> panel_of_triangle() const {
        std::vector<int> panel;
        for (const auto& t : sheet_.triangles) panel.push_back(t.panel);
        return panel;
    }
    /// The triangles along the joints, but not where the skin is too sharp for a band below it.
    std::vector<int> band_of_triangle() const {
        std::vector<bool> on_joint(sheet_.vertices.size(), false);
        for (const auto& border : panels_.borders) {
            if (border.neighbour == kNoPanel || gap_mm(border) <= 0.0) continue;
            on_joint[panels_.vertex[border.from]] = on_joint[panels_.vertex[border.to]] = true;
        }
        std::vector<int> band;
        for (const auto& t : sheet_.triangles) {
            const auto& c = t.corners;
            const bool touches = on_joint[c.x] || on_joint[c.y] || on_joint[c.z];
            const double least = std::min({thickness_[c.x], thickness_[c.y], thickness_[c.z]});
            const bool has_room = least >= kLeastThickness;
            band.push_back(t.panel != kNoPanel && touches && has_room ? 0 : kNoPanel);
        }
        return band;
    }

    double inset_mm(int panel, std::uint32_t v) const {
        const auto& style = style_of(panel);
        return style.inset_mm + (style.relief_mm ? style.relief_mm(sheet_.vertices[v]) : 0.0);
    }
    glm::dvec3 below(std::uint32_t v, double depth_mm) const {
        const auto& vertex = sheet_.vertices[v];
        return vertex.position - vertex.normal * (depth_mm * thickness_[v]);
    }
    glm::dvec3 outer(std::uint32_t post) const {
        return below(panels_.vertex[post], inset_mm(panels_.piece[post], panels_.vertex[post])) +
               mitre_[post] * step_mm_[post];
    }
    glm::dvec3 inner(std::uint32_t post) const {
        return below(panels_.vertex[post], depth_mm_[post]) + mitre_[post] * step_mm_[post];
    }
    /// The band is a little smaller than its triangles, so that it has edges where it touches
    /// itself.
    glm::dvec3 in_band(std::uint32_t post, double depth_mm) const {
        return below(band_.vertex[post], depth_mm) + band_inward_[post] * band_step_mm_[post];
    }
    double band_top(std::uint32_t v) const { return deepest_mm_[v] + kJointBelow_mm; }
    double band_bottom(std::uint32_t v) const { return band_top(v) + kJointThick_mm; }

    void thin_all() {
        constexpr int kMostRounds = 60;
        for (int round = 0; round < kMostRounds && thin() > 0; ++round) {
        }
    }
    void lay_band() {
        band_ = stand_posts(sheet_, band_of_triangle());
        band_inward_ = mitres(sheet_, band_, true);
        band_step_mm_.assign(band_.vertex.size(), kBandStep_mm);
    }
    void find_steps();
    void find_depths();
    void keep_clear();
    std::size_t thin();

    const Sheet& sheet_;
    const std::vector<PanelStyle>& styles_;
    Posts panels_, band_;
    std::vector<glm::dvec3> mitre_, inward_;  ///< by post of the panels
    std::vector<double> step_mm_;             ///< how far it steps back, half the gap
    std::vector<glm::dvec3> band_inward_;     ///< by post of the band
    std::vector<double> band_step_mm_;
    std::vector<double> depth_mm_;    ///< of its inner end, before thinning
    std::vector<double> deepest_mm_;  ///< by vertex, over the panels there
    std::vector<double> thickness_;   ///< by vertex, of all depths
};

void PanelBuilder::find_steps() {
    step_mm_.assign(panels_.vertex.size(), 0.0);
    for (const auto& border : panels_.borders) {
        if (border.neighbour == kNoPanel) continue;
        const double gap = std::max(kSlit_mm, gap_mm(border));
        for (const auto post : {border.from, border.to}) {
            step_mm_[post] = std::max(step_mm_[post], 0.5 * gap);
        }
    }
    // Short edges, as in a panel's tip, bound the step, so that no triangle flips.
    constexpr double kOfShortestEdge = 0.35;
    for (const auto& post : panels_.of_triangle) {
        if (post.x >= panels_.vertex.size()) continue;
        for (int k = 0; k < 3; ++k) {
            const auto a = post[k], b = post[(k + 1) % 3];
            const double most =
                kOfShortestEdge * length_between(sheet_, panels_.vertex[a], panels_.vertex[b]);
            step_mm_[a] = std::min(step_mm_[a], most);
            step_mm_[b] = std::min(step_mm_[b], most);
        }
    }
}

void PanelBuilder::find_depths() {
    for (std::size_t p = 0; p < panels_.piece.size(); ++p) {
        const int panel = panels_.piece[p];
        depth_mm_.push_back(inset_mm(panel, panels_.vertex[p]) + style_of(panel).wall_mm);
    }
    for (const auto& border : panels_.borders) {
        if (border.neighbour == kNoPanel) continue;
        for (const auto post : {border.from, border.to}) {
            depth_mm_[post] = std::max(
                depth_mm_[post], inset_mm(border.neighbour, panels_.vertex[post]) + kOverlap_mm);
        }
    }
    deepest_mm_.assign(sheet_.vertices.size(), 0.0);
    for (std::size_t p = 0; p < depth_mm_.size(); ++p) {
        auto& deepest = deepest_mm_[panels_.vertex[p]];
        deepest = std::max(deepest, depth_mm_[p]);
    }
}

/// Nothing reaches deeper than most of the way to the skin's medial axis, so that what hangs below
/// one place meets nothing below another, as at a sharp edge.
void PanelBuilder::keep_clear() {
    constexpr double kOfRadius = 0.5;
    std::vector<bool> is_kept(sheet_.vertices.size(), false);
    for (const auto v : panels_.vertex) is_kept[v] = true;
    double deepest = 0.0;
    for (std::uint32_t v = 0; v < is_kept.size(); ++v) deepest = std::max(deepest, band_bottom(v));
    const double reach = 2.0 * deepest / kOfRadius;  // no point further away bounds a depth
    std::map<std::array<int, 3>, std::vector<std::uint32_t>> cells;
    const auto cell_of = [&](const glm::dvec3& p) {
        return std::array<int, 3>{static_cast<int>(std::floor(p.x / reach)),
                                  static_cast<int>(std::floor(p.y / reach)),
                                  static_cast<int>(std::floor(p.z / reach))};
    };
    for (std::uint32_t v = 0; v < is_kept.size(); ++v) {
        if (is_kept[v]) cells[cell_of(sheet_.vertices[v].position)].push_back(v);
    }
    for (std::uint32_t v = 0; v < is_kept.size(); ++v) {
        if (!is_kept[v]) continue;
        const auto& [place, normal, parameters] = sheet_.vertices[v];
        // The smallest ball that touches the skin here from inside and at another point.
        double radius = deepest / kOfRadius;
        const auto here = cell_of(place);
        for (int k = 0; k < 27; ++k) {
            const auto cell =
                cells.find({here[0] + k % 3 - 1, here[1] + k / 3 % 3 - 1, here[2] + k / 9 - 1});
            if (cell == cells.end()) continue;
            for (const auto other : cell->second) {
                const auto apart = place - sheet_.vertices[other].position;
                const double down = glm::dot(apart, normal);
                const double distance2 = glm::dot(apart, apart);
                if (down > 1e-3 * std::sqrt(distance2)) {
                    radius = std::min(radius, 0.5 * distance2 / down);
                }
            }
        }
        thickness_[v] = std::min(1.0, kOfRadius * radius / band_bottom(v));
    }
    // In bowls and on what stands in them it changes slowly, or their floors would ripple.
    constexpr double kChangePerMm = 0.1, kDeep_mm = 0.3;
    std::vector<bool> in_bowl(styles_.size(), false);
    for (const auto& border : panels_.borders) {
        if (border.neighbour == kNoPanel) continue;
        const int panel = panels_.piece[border.from];
        if (style_of(panel).relief_mm) in_bowl[static_cast<std::size_t>(panel)] = true;
        if (style_of(border.neighbour).relief_mm && style_of(panel).inset_mm > kDeep_mm) {
            in_bowl[static_cast<std::size_t>(panel)] = true;
        }
    }
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (const auto& t : sheet_.triangles) {
            if (t.panel == kNoPanel || !in_bowl[static_cast<std::size_t>(t.panel)]) continue;
            for (int k = 0; k < 6; ++k) {
                const auto a = t.corners[k % 3], b = t.corners[(k + 1 + k / 3) % 3];
                const double most = thickness_[b] + kChangePerMm * length_between(sheet_, a, b);
                if (thickness_[a] <= most + 1e-9) continue;
                thickness_[a] = most;
                has_changed = true;
            }
        }
    }
}

/// Looks for triangles that lean over or shrink to nothing on their way down, and makes them less
/// deep, or their joint narrower. Returns how many there were.
std::size_t PanelBuilder::thin() {
    constexpr double kLean_cos = 0.5, kLeastArea = 0.1, kLess = 0.8, kLeast = 0.05,
                     kLeastHeight_mm = 0.004;
    std::vector<bool> too_deep(sheet_.vertices.size(), false);
    std::vector<bool> too_far(panels_.vertex.size(), false);
    std::size_t count = 0;
    const auto normal_of = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        return glm::cross(b - a, c - a);
    };
    for (std::size_t k = 0; k < sheet_.triangles.size(); ++k) {
        const auto& t = sheet_.triangles[k];
        if (t.panel == kNoPanel) continue;
        const auto at = [&](int c) { return sheet_.vertices[t.corners[c]].position; };
        const auto whole = normal_of(at(0), at(1), at(2));
        const auto is_bad = [&](const auto& place, double lean_cos) {
            const auto now = normal_of(place(0), place(1), place(2));
            const double along = glm::dot(now, whole) / glm::dot(whole, whole);
            const double longest = std::max({glm::distance(place(0), place(1)),
                                             glm::distance(place(1), place(2)),
                                             glm::distance(place(2), place(0))});
            return along < kLeastArea || along * glm::length(whole) < lean_cos * glm::length(now) ||
                   glm::length(now) < kLeastHeight_mm * longest;
        };
        // Relief and depths that change lean by themselves.
        const auto& post = panels_.of_triangle[k];
        const bool outer_bad = is_bad([&](int c) { return outer(post[c]); },
                                      style_of(t.panel).relief_mm ? 0.0 : kLean_cos);
        bool bad = outer_bad || is_bad([&](int c) { return inner(post[c]); }, 0.0);
        const auto under = band_.vertex.empty() ? glm::uvec3(0) : band_.of_triangle[k];
        const bool has_band = under.x < band_.vertex.size();
        const bool band_bad =
            has_band &&
            is_bad([&](int c) { return in_band(under[c], band_bottom(t.corners[c])); }, 0.0);
        bad = bad || band_bad;
        if (!bad) continue;
        ++count;
        for (int c = 0; c < 3; ++c) {
            too_deep[t.corners[c]] = true;
            if (outer_bad) too_far[post[c]] = true;
            if (band_bad) band_step_mm_[under[c]] *= kLess;
        }
    }
    for (std::size_t v = 0; v < too_deep.size(); ++v) {
        if (too_deep[v]) thickness_[v] = std::max(kLeast, thickness_[v] * kLess);
    }
    for (std::size_t p = 0; p < too_far.size(); ++p) {
        if (too_far[p])
            step_mm_[p] = std::max(std::min(step_mm_[p], kBandStep_mm), step_mm_[p] * kLess);
    }
    return count;
}

}  // namespace

void build_panels(const Sheet& sheet,
                  const std::vector<PanelStyle>& styles,
                  const ChartFunction& chart,
                  int joint_part,
                  std::vector<PartMesh>& parts) {
    constexpr double kNeedle_mm = 0.03;
    const Sheet tidy = without_needles(sheet, kNeedle_mm);
    const PanelBuilder builder(tidy, styles);
    builder.add_panels(chart, parts);
    builder.add_joints(chart, parts[static_cast<std::size_t>(joint_part)]);
}

}  // namespace livery::assets
