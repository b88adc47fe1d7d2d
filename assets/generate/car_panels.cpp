#include "car_panels.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "car_cage.h"
#include "panel_cutter.h"

namespace livery::assets {

std::vector<PanelStyle> cut_car_panels(Sheet& sheet) {
    const Cutter cutter{sheet};
    // The floor inside a flange along the sills; the wells reach into it.
    for (auto& t : sheet.triangles) {
        if (t.region == kFloor && cutter.row(t) > kSillRow + 1) t.panel = kUnderbody;
    }
    // The wheel openings first: what they take away needs no more cuts. In the floor they end in
    // front of the wells' inner walls.
    for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
        cutter.along(
            [&](const LimitVertex& v) {
                return glm::distance(side_view(v), {axle, kAxleHeight_mm}) - kArchRadius_mm;
            },
            {kFenders, kUnderbody},
            kNoPanel,
            [&](const SheetTriangle& t) {
                return cutter.centre(t).z > (t.panel == kUnderbody ? kWellDepth_mm - 1.0 : 20.0);
            });
    }
    cut_windows(cutter);
    cut_ends(cutter);
    // The dark sill rises toward the tail.
    cutter.along([](const LimitVertex& v) { return v.position.y - 10.1 + 0.014 * v.position.x; },
                 {kFenders},
                 kLowerTrim,
                 [&](const SheetTriangle& t) { return t.region != kTop; });
    cut_lids(cutter);

    constexpr double kJoint_mm = 0.16;
    std::vector<PanelStyle> styles(kPanels, {kBody, 0.0, kJoint_mm, 0.7});
    const auto style = [&](Panel panel, CarPart part, double inset_mm, double gap_mm) {
        styles[panel] = {part, inset_mm, gap_mm, 0.7};
    };
    for (const auto glass :
         {kWindscreen, kRearScreen, kFrontSideGlass, kRearSideGlass, kQuarterGlass}) {
        style(glass, kGlass, 0.2, 0.1);
    }
    style(kWindowFrame, kTrim, 0.08, 0.1);
    style(kLowerTrim, kTrim, 0.15, 0.0);
    style(kUnderbody, kTrim, 0.0, 0.0);
    styles[kUnderbody].is_coarse = true;
    styles[kFenders].wall_mm = styles[kHatch].wall_mm = 1.0;
    style(kDoorHandle, kBody, -0.12, 0.14);
    style_ends(styles);
    return styles;
}

Flare arch_flare(const glm::dvec2& side) {
    constexpr double kHeight_mm = 0.35, kWidth_mm = 4.6;
    constexpr double kGone_mm = 8.0, kWhole_mm = 18.0;  // it runs out toward the sill
    const double up = std::clamp((side.y - kGone_mm) / (kWhole_mm - kGone_mm), 0.0, 1.0);
    const double fade = up * up * (3.0 - 2.0 * up);
    const double fade_slope = 6.0 * up * (1.0 - up) / (kWhole_mm - kGone_mm);
    Flare flare;
    for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
        const auto from_axle = side - glm::dvec2(axle, kAxleHeight_mm);
        const double r = glm::length(from_axle);
        const double t = (r - kArchRadius_mm) / kWidth_mm;
        if (t >= 1.0 || r < 1e-9) continue;
        // (1 - t^2)^3 outside the opening, constant inside: smooth to the second derivative at its
        // foot.
        const double inside = std::max(t, 0.0);
        const double one = 1.0 - inside * inside;
        const double height = kHeight_mm * one * one * one;
        const double slope = -6.0 * kHeight_mm * inside * one * one / kWidth_mm;
        flare.height_mm += height * fade;
        flare.gradient += from_axle * (fade * slope / r) + glm::dvec2(0.0, height * fade_slope);
    }
    return flare;
}

}  // namespace livery::assets
