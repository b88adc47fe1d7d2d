#include "car_panels.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "car_cage.h"
#include "outline.h"

namespace livery::assets {

namespace {

enum Panel {
    kFenders,  // what is left of the skin: front fenders, roof sides, rear quarters
    kWindscreen,
    kRearScreen,
    kFrontSideGlass,
    kRearSideGlass,
    kWindowFrame,
    kRoof,
    kBonnet,
    kHatch,
    kFrontDoor,
    kRearDoor,
    kFrontBumper,
    kRearBumper,
    kHeadLamp,
    kTailLamp,
    kGrille,
    kIntake,
    kLowerTrim,
    kDoorHandle,
    kLampFrame,
    kGrilleBar,
    kPlateRecess,
    kPanels,
};

using Points = std::vector<glm::dvec2>;

glm::dvec2 side_view(const LimitVertex& v) { return {v.position.x, v.position.y}; }
glm::dvec2 top_view(const LimitVertex& v) { return {v.position.x, v.position.z}; }

glm::dvec2 end_view(const LimitVertex& v) { return {v.position.z, v.position.y}; }

/// Developed around an upright axis: angle from straight ahead (or back), in degrees, and height.
glm::dvec2 nose_view(const LimitVertex& v) {
    return {std::atan2(v.position.z, v.position.x - 48.0) * 57.29577951308232, v.position.y};
}
glm::dvec2 tail_view(const LimitVertex& v) {
    return {std::atan2(v.position.z, -48.0 - v.position.x) * 57.29577951308232, v.position.y};
}

glm::dvec2 side_of(double station, double row) {
    const auto p = feature_point(station, row);
    return {p.x, p.y};
}
glm::dvec2 top_of(double station, double row) {
    const auto p = feature_point(station, row);
    return {p.x, p.z};
}

/// How far a point lies behind the line between the doors, which leans back above the belt and
/// forward below.
double behind_pillar_mm(const LimitVertex& v) {
    const double above = v.position.y - 39.5;
    return -(v.position.x + 8.6 + (above > 0.0 ? 0.10 : 0.09) * above);
}

/// Both halves of an outline that crosses the centre line, from its points with z >= 0.
Points mirrored(Points half) {
    Points all = half;
    for (auto p = half.rbegin(); p != half.rend(); ++p) {
        if (p->y > 0.0) all.emplace_back(p->x, -p->y);
    }
    return all;
}

/// The side windows as one opening, in side view.
Outline side_window() {
    Points corners;
    for (double s : {13.35, 12.5, 11.5, 10.5, 9.5, 8.5, 7.5, 6.5, 5.5, 4.6}) {
        corners.push_back(side_of(s, 4.35) + glm::dvec2(0.0, -0.1));
    }
    corners.push_back(side_of(3.75, 5.0));
    corners.push_back(side_of(4.0, 5.72) + glm::dvec2(0.0, 0.2));
    for (double s : {5.5, 7.0, 8.5, 10.0, 11.5, 12.7}) corners.push_back(side_of(s, 5.86));
    return Outline(corners, 1.6);
}

struct Cutter {
    Sheet& sheet;

    using View = glm::dvec2 (*)(const LimitVertex&);

    /// Panels in `from` become `to` inside the outline moved outward by `offset`.
    void operator()(const Outline& outline,
                    View view,
                    double offset,
                    std::vector<int> from,
                    int to,
                    const TriangleMask& where) {
        along([&](const LimitVertex& v) { return outline.signed_distance(view(v)) - offset; },
              std::move(from),
              to,
              where);
    }
    void along(const CutFunction& f, std::vector<int> from, int to, const TriangleMask& where) {
        const auto is_from = [&](int panel) {
            return std::find(from.begin(), from.end(), panel) != from.end();
        };
        cut(
            sheet,
            f,
            [&](const SheetTriangle& t) { return is_from(t.panel) && where(t); },
            [&](int) { return to; });
    }
    glm::dvec3 centre(const SheetTriangle& t) const {
        return (sheet.vertices[t.corners.x].position + sheet.vertices[t.corners.y].position +
                sheet.vertices[t.corners.z].position) /
               3.0;
    }
    double row(const SheetTriangle& t) const {
        return (sheet.vertices[t.corners.x].parameters.y +
                sheet.vertices[t.corners.y].parameters.y +
                sheet.vertices[t.corners.z].parameters.y) /
               3.0;
    }
};

void cut_windows(Cutter& cutter) {
    const auto& row = [&](const SheetTriangle& t) { return cutter.row(t); };
    const TriangleMask on_side = [&](const SheetTriangle& t) {
        return t.region == kTop && row(t) > 3.3 && row(t) < 7.0;
    };
    const auto window = side_window();
    cutter(window, side_view, 0.75, {kFenders}, kWindowFrame, on_side);
    cutter(window, side_view, 0.0, {kWindowFrame}, kRearSideGlass, on_side);
    // The middle pillar parts the glass, leaning back.
    cutter.along([](const LimitVertex& v) { return behind_pillar_mm(v) + 0.9; },
                 {kRearSideGlass},
                 kFrontSideGlass,
                 on_side);
    cutter.along([](const LimitVertex& v) { return behind_pillar_mm(v) - 0.9; },
                 {kRearSideGlass},
                 kWindowFrame,
                 on_side);

    const TriangleMask on_top = [&](const SheetTriangle& t) {
        return t.region == kTop && row(t) < 3.6;
    };
    Points screen;
    for (double r : {0.0, 1.0, 2.0, 2.55}) screen.push_back(top_of(10.25, r));
    screen.push_back(top_of(10.4, 2.8));
    for (double s : {11.0, 12.0, 13.0, 13.5}) screen.push_back(top_of(s, 2.88));
    for (double r : {2.4, 1.6, 0.8, 0.0}) screen.push_back(top_of(13.75, r));
    cutter(Outline(mirrored(screen), 2.0), top_view, 0.0, {kFenders}, kWindscreen, on_top);
    Points rear;
    for (double r : {0.0, 1.0, 2.0, 2.45}) rear.push_back(top_of(4.75, r));
    rear.push_back(top_of(4.5, 2.75));
    for (double s : {3.8, 3.0, 2.4}) rear.push_back(top_of(s, 2.8));
    for (double r : {2.5, 1.6, 0.8, 0.0}) rear.push_back(top_of(1.95, r));
    cutter(Outline(mirrored(rear), 2.0), top_view, 0.0, {kFenders}, kRearScreen, on_top);
}

void cut_ends(Cutter& cutter) {
    const TriangleMask in_front = [&](const SheetTriangle& t) { return cutter.centre(t).x > 58.0; };
    const TriangleMask behind = [&](const SheetTriangle& t) { return cutter.centre(t).x < -58.0; };
    const Outline head({{20.5, 26.4},
                        {30.0, 27.2},
                        {42.0, 28.4},
                        {54.0, 29.9},
                        {67.0, 32.0},
                        {60.0, 28.6},
                        {47.0, 25.8},
                        {36.0, 24.6},
                        {22.5, 24.4}},
                       1.0);
    cutter(head, nose_view, 0.0, {kFenders}, kLampFrame, in_front);
    cutter(head, nose_view, -0.55, {kLampFrame}, kHeadLamp, in_front);
    const Outline grille(
        {{-18.6, 26.2}, {18.6, 26.2}, {20.6, 24.2}, {16.5, 17.6}, {-16.5, 17.6}, {-20.6, 24.2}},
        1.6);
    cutter(grille, nose_view, 0.0, {kFenders}, kGrille, in_front);
    // Bars across the grille, cut out of the depth behind them.
    cutter.along([](const LimitVertex& v) { return std::cos((v.position.y - 17.6) * 2.9) - 0.25; },
                 {kGrille},
                 kGrilleBar,
                 in_front);
    const Outline intake(
        {{-22.0, 14.4}, {22.0, 14.4}, {26.0, 12.6}, {23.0, 10.4}, {-23.0, 10.4}, {-26.0, 12.6}},
        1.4);
    cutter(intake, nose_view, 0.0, {kFenders}, kIntake, in_front);
    const Outline vent({{31.0, 18.4}, {43.0, 20.4}, {44.5, 17.0}, {36.0, 12.2}, {32.0, 12.2}}, 1.4);
    cutter(vent, nose_view, 0.0, {kFenders}, kIntake, in_front);

    const Outline tail({{-70.0, 39.6},
                        {-40.0, 39.2},
                        {0.0, 38.6},
                        {40.0, 39.2},
                        {70.0, 39.6},
                        {62.0, 37.2},
                        {50.0, 34.6},
                        {36.0, 34.2},
                        {25.0, 35.6},
                        {0.0, 35.8},
                        {-25.0, 35.6},
                        {-36.0, 34.2},
                        {-50.0, 34.6},
                        {-62.0, 37.2}},
                       1.2);
    cutter(tail, tail_view, 0.0, {kFenders}, kLampFrame, behind);
    cutter(tail, tail_view, -0.45, {kLampFrame}, kTailLamp, behind);
    const Outline plate({{-13.0, 32.6}, {13.0, 32.6}, {14.5, 26.4}, {-14.5, 26.4}}, 1.4);
    cutter(plate, tail_view, 0.0, {kFenders}, kPlateRecess, behind);
    const Outline diffuser(
        {{-38.0, 4.0}, {-38.0, 11.0}, {-28.0, 14.4}, {28.0, 14.4}, {38.0, 11.0}, {38.0, 4.0}}, 2.0);
    cutter(diffuser, tail_view, 0.0, {kFenders}, kIntake, behind);
}

void cut_lids(Cutter& cutter) {
    const TriangleMask on_side = [&](const SheetTriangle& t) {
        return t.region == kSide || (t.region == kTop && cutter.row(t) > 3.6);
    };
    const TriangleMask on_top = [&](const SheetTriangle& t) {
        return t.region == kTop && cutter.row(t) < 7.4;
    };
    // Doors: under the window frame; the rear one cut back around the arch.
    const Outline doors({{29.5, 36.0},
                         {27.0, 39.4},
                         {22.0, 43.5},
                         {0.0, 70.0},
                         {-44.0, 70.0},
                         {-43.6, 41.0},
                         {-42.4, 33.0},
                         {-38.6, 27.0},
                         {-35.6, 18.0},
                         {-35.0, 11.6},
                         {27.0, 11.6},
                         {30.0, 15.0},
                         {31.0, 26.0}},
                        2.2);
    const TriangleMask under_window = [&](const SheetTriangle& t) {
        return on_side(t) && cutter.row(t) > 5.6;
    };
    cutter(doors, side_view, 0.0, {kFenders}, kRearDoor, under_window);
    cutter.along([](const LimitVertex& v) { return behind_pillar_mm(v); },
                 {kRearDoor},
                 kFrontDoor,
                 under_window);
    for (const double x : {-1.2, -36.6}) {
        const double y = x > -20 ? 34.6 : 35.4;
        const Outline handle(
            {{x - 3.6, y + 0.75}, {x + 3.6, y + 0.65}, {x + 3.6, y - 0.65}, {x - 3.6, y - 0.55}},
            0.7);
        cutter(handle, side_view, 0.0, {kFrontDoor, kRearDoor}, kDoorHandle, on_side);
    }

    Points bonnet;
    for (double r : {0.0, 1.0, 2.0, 3.0, 3.7}) bonnet.push_back(top_of(14.1, r));
    bonnet.push_back({37.5, 32.4});
    bonnet.push_back({54.0, 31.2});
    bonnet.push_back({68.0, 28.6});
    bonnet.push_back({77.0, 25.0});
    bonnet.push_back({82.6, 19.0});
    bonnet.push_back({85.4, 9.0});
    bonnet.push_back({86.0, 0.0});
    cutter(Outline(mirrored(bonnet), 2.4), top_view, 0.0, {kFenders}, kBonnet, on_top);
    Points hatch;
    for (double r : {0.0, 1.0, 2.0, 2.7}) hatch.push_back(top_of(5.05, r));
    hatch.push_back(top_of(4.3, 3.3));
    hatch.push_back(top_of(3.0, 3.4));
    hatch.push_back(top_of(2.0, 4.2));
    hatch.push_back({-78.0, 26.0});
    hatch.push_back({-100.0, 26.0});
    hatch.push_back({-100.0, 0.0});
    cutter(Outline(mirrored(hatch), 2.4), top_view, 0.0, {kFenders}, kHatch, [&](const auto& t) {
        return t.region == kTop && cutter.row(t) < 7.4;
    });
    const Outline lower_hatch(
        {{-26.0, 60.0}, {-26.0, 25.4}, {-23.5, 23.0}, {23.5, 23.0}, {26.0, 25.4}, {26.0, 60.0}},
        2.0);
    cutter.along(
        [](const LimitVertex& v) { return 63.2 + 0.15 * (32.0 - v.position.y) - v.position.x; },
        {kFenders},
        kFrontBumper,
        [&](const SheetTriangle& t) { return cutter.centre(t).x > 56.0; });
    cutter(lower_hatch, end_view, 0.0, {kFenders}, kHatch, [&](const SheetTriangle& t) {
        return t.region == kTail;
    });
    cutter.along([](const LimitVertex& v) { return v.position.y - 25.2; },
                 {kFenders},
                 kRearBumper,
                 [&](const SheetTriangle& t) { return cutter.centre(t).x < -58.0; });
}

}  // namespace

std::vector<PanelStyle> cut_car_panels(Sheet& sheet) {
    Cutter cutter{sheet};
    // The wheel openings first: what they take away needs no more cuts.
    for (const double axle : {kFrontAxle_mm, kRearAxle_mm}) {
        cutter.along(
            [&](const LimitVertex& v) {
                return glm::distance(side_view(v), {axle, kAxleHeight_mm}) - kArchRadius_mm;
            },
            {kFenders},
            kNoPanel,
            [&](const SheetTriangle& t) { return cutter.centre(t).z > 20.0; });
    }
    cut_windows(cutter);
    cut_ends(cutter);
    cutter.along([](const LimitVertex& v) { return v.position.y - 10.2; },
                 {kFenders},
                 kLowerTrim,
                 [&](const SheetTriangle& t) { return t.region != kTop; });
    cut_lids(cutter);

    constexpr double kJoint_mm = 0.16;
    std::vector<PanelStyle> styles(kPanels, {kBody, 0.0, kJoint_mm, 0.7});
    const auto style = [&](Panel panel, CarPart part, double inset_mm, double gap_mm) {
        styles[panel] = {part, inset_mm, gap_mm, 0.7};
    };
    for (const auto glass : {kWindscreen, kRearScreen, kFrontSideGlass, kRearSideGlass}) {
        style(glass, kGlass, 0.10, 0.06);
    }
    style(kWindowFrame, kTrim, 0.04, 0.06);
    style(kHeadLamp, kLights, 0.08, 0.12);
    style(kTailLamp, kLights, 0.0, 0.12);
    style(kLampFrame, kTrim, 0.1, 0.12);
    style(kGrille, kTrim, 0.9, 0.0);
    style(kGrilleBar, kTrim, 0.25, 0.0);
    styles[kGrille].wall_mm = 0.0;
    style(kIntake, kTrim, 0.9, 0.0);
    styles[kIntake].wall_mm = 0.0;
    style(kLowerTrim, kTrim, 0.15, 0.0);
    style(kPlateRecess, kBody, 0.55, 0.0);
    styles[kFenders].wall_mm = styles[kHatch].wall_mm = 1.0;
    style(kDoorHandle, kBody, -0.12, 0.14);
    return styles;
}

Flare arch_flare(const glm::dvec2& side) {
    constexpr double kHeight_mm = 0.9, kWidth_mm = 7.0;
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
        flare.height_mm += kHeight_mm * one * one * one;
        const double slope = -6.0 * kHeight_mm * inside * one * one / kWidth_mm;
        flare.gradient += from_axle * (slope / r);
    }
    return flare;
}

}  // namespace livery::assets
