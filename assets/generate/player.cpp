#include "player.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>

#include "outline.h"
#include "pebble.h"
#include "refine.h"
#include "sheet.h"

namespace livery::assets {

namespace {

enum PlayerPart { kShell, kBack, kPlayerGlass, kWheel, kButton, kPlayerTrim, kPlayerParts };
enum PlayerPanel {
    kShellPanel,
    kBackPanel,
    kSeam,
    kScreen,
    kWheelRing,
    kCentreButton,
    kPorts,
    kSlider,
    kPlayerPanels,
};

constexpr Pebble kPebble;
constexpr double kWall_mm = 1.6;
constexpr double kWheelY_mm = -24.5, kWheelRadius_mm = 17.5, kButtonRadius_mm = 6.4;
constexpr double kEdge_mm = 0.3;  ///< how wide the edges of glass and wheel are rounded
constexpr double kSeamFrom_mm = -1.6, kSeamTo_mm = -0.9;

/// Signed distance on the skin, negative inside.
using Distance = std::function<double(const LimitVertex&)>;

Distance in_front(const Outline& outline) {
    return [outline](const LimitVertex& v) {
        return outline.signed_distance({v.position.z, v.position.y});
    };
}
Distance on_end(const Outline& outline) {
    return [outline](const LimitVertex& v) {
        return outline.signed_distance({v.position.z, v.position.x});
    };
}
Distance around_wheel(double radius_mm) {
    return [radius_mm](const LimitVertex& v) {
        return std::hypot(v.position.z, v.position.y - kWheelY_mm) - radius_mm;
    };
}
/// A rectangle about (0, y) with round corners.
Outline rounded(double half_width, double half_height, double y, double radius) {
    return Outline({{-half_width, y - half_height},
                    {half_width, y - half_height},
                    {half_width, y + half_height},
                    {-half_width, y + half_height}},
                   radius);
}
Outline disc(double z, double x, double radius) {
    std::vector<glm::dvec2> corners;
    constexpr int kCorners = 12;
    for (int k = 0; k < kCorners; ++k) {
        const double turn = 6.283185307179586 * k / kCorners;
        corners.emplace_back(z + radius * std::cos(turn), x + radius * std::sin(turn));
    }
    return Outline(corners, radius);
}

/// Depth of an edge that is rounded off: a quarter of a circle, flattened.
double rounded_edge_mm(double inside_mm) {
    const double t = std::clamp(1.0 - inside_mm / kEdge_mm, 0.0, 1.0);
    return 0.6 * kEdge_mm * t * t;
}

class PlayerCutter {
  public:
    explicit PlayerCutter(Sheet& sheet) : sheet_(sheet) {}

    /// Panel `from` becomes `to` inside, with triangles half or a quarter as large at its outline.
    void inlay(const Distance& distance,
               int from,
               int to,
               const TriangleMask& where,
               int refinements,
               bool has_edge) {
        for (double reach_mm = 1.6; refinements > 0; --refinements, reach_mm *= 0.5) {
            refine(sheet_, [&](const SheetTriangle& t) {
                return t.panel == from && where(t) && std::abs(distance(centre(t))) < reach_mm;
            });
        }
        along(distance, from, to, where);
        if (!has_edge) return;
        for (const double inside_mm : {0.45 * kEdge_mm, kEdge_mm}) {
            along([&](const LimitVertex& v) { return distance(v) + inside_mm; }, to, to, where);
        }
    }
    void along(const Distance& distance, int from, int to, const TriangleMask& where) {
        cut(
            sheet_,
            distance,
            [&](const SheetTriangle& t) { return t.panel == from && where(t); },
            [to](int) { return to; });
    }
    LimitVertex centre(const SheetTriangle& t) const {
        LimitVertex middle;
        for (int k = 0; k < 3; ++k) middle.position += sheet_.vertices[t.corners[k]].position / 3.0;
        return middle;
    }

  private:
    Sheet& sheet_;
};

std::vector<PanelStyle> cut_player(Sheet& sheet) {
    PlayerCutter cutter(sheet);
    const TriangleMask front = [&](const SheetTriangle& t) {
        return cutter.centre(t).position.x > 2.0;
    };
    const auto end = [&](double sign) -> TriangleMask {
        return [&cutter, sign](const SheetTriangle& t) {
            return sign * cutter.centre(t).position.y > 47.0;
        };
    };
    const Distance screen = in_front(rounded(24.5, 19.5, 25.0, 4.0));
    cutter.inlay(screen, kShellPanel, kScreen, front, 1, true);
    cutter.inlay(around_wheel(kWheelRadius_mm), kShellPanel, kWheelRing, front, 1, true);
    cutter.inlay(around_wheel(kButtonRadius_mm), kWheelRing, kCentreButton, front, 1, true);

    // Around the side: a line of trim between shell and back.
    const TriangleMask everywhere = [](const SheetTriangle&) { return true; };
    cutter.along([](const LimitVertex& v) { return v.position.x - kSeamTo_mm; },
                 kShellPanel,
                 kSeam,
                 everywhere);
    cutter.along([](const LimitVertex& v) { return v.position.x - kSeamFrom_mm; },
                 kSeam,
                 kBackPanel,
                 everywhere);

    // Below: the connector, beside it the speaker's holes; above: the hold switch and an earpiece.
    constexpr double kLine_mm = 1.35;
    cutter.inlay(
        on_end(rounded(5.2, 0.95, kLine_mm, 0.95)), kShellPanel, kPorts, end(-1.0), 2, false);
    for (const double z : {11.0, 13.4, 15.8}) {
        cutter.inlay(on_end(disc(z, kLine_mm, 0.6)), kShellPanel, kPorts, end(-1.0), 3, false);
    }
    cutter.inlay(
        on_end(rounded(4.6, 0.85, kLine_mm, 0.85)), kShellPanel, kSlider, end(1.0), 2, false);
    cutter.inlay(in_front(rounded(5.0, 0.45, 47.4, 0.45)), kShellPanel, kPorts, front, 2, false);

    std::vector<PanelStyle> styles(kPlayerPanels, {kShell, 0.0, 0.12, kWall_mm});
    styles[kBackPanel].part = kBack;
    styles[kSeam] = {kPlayerTrim, 0.1, 0.1, 1.2};
    styles[kScreen] = {kPlayerGlass, 0.1, 0.12, 1.0, [screen](const LimitVertex& v) {
                           return rounded_edge_mm(-screen(v));
                       }};
    styles[kWheelRing] = {kWheel, 0.05, 0.16, 1.2, [](const LimitVertex& v) {
                              // Dished between its edges, so that a thumb finds it.
                              const double r = std::hypot(v.position.z, v.position.y - kWheelY_mm);
                              const double middle = 0.5 * (kWheelRadius_mm + kButtonRadius_mm);
                              const double half = 0.5 * (kWheelRadius_mm - kButtonRadius_mm);
                              const double t = std::min(1.0, std::abs(r - middle) / half);
                              const double dish = 0.55 * (1.0 - t * t) * (1.0 - t * t);
                              return dish + rounded_edge_mm(kWheelRadius_mm - r) +
                                     rounded_edge_mm(r - kButtonRadius_mm);
                          }};
    styles[kCentreButton] = {kButton, 0.05, 0.16, 1.2, [](const LimitVertex& v) {
                                 const double r =
                                     std::hypot(v.position.z, v.position.y - kWheelY_mm);
                                 return rounded_edge_mm(kButtonRadius_mm - r);
                             }};
    styles[kPorts] = {kPlayerTrim, 0.8, 0.08, 0.5};
    styles[kSlider] = {kButton, -0.35, 0.14, 1.2};
    return styles;
}

glm::dvec2 chart(const LimitVertex& v, int region) {
    return {v.position.z, v.position.y + (region == kFront ? 0.0 : kUvUnit_mm)};
}

}  // namespace

std::vector<PartMesh> make_player() {
    constexpr double kSpacing_mm = 1.2;
    auto sheet = pebble_sheet(kPebble, kSpacing_mm);
    const auto styles = cut_player(sheet);

    std::vector<PartMesh> half(kPlayerParts);
    build_panels(sheet, styles, chart, kPlayerTrim, half);
    const std::array<PartStyle, kPlayerParts> looks{{{"shell", glm::dvec3(0.75), 0.3},
                                                     {"back", glm::dvec3(0.75), 0.3},
                                                     {"glass", glm::dvec3(0.03), 0.1},
                                                     {"wheel", glm::dvec3(0.6), 0.5},
                                                     {"button", glm::dvec3(0.7), 0.4},
                                                     {"trim", glm::dvec3(0.06), 0.4}}};
    return mirrored_parts(looks, half);
}

}  // namespace livery::assets
