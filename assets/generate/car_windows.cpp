#include "car_cage.h"
#include "panel_cutter.h"

namespace livery::assets {

namespace {

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

}  // namespace

void cut_windows(const Cutter& cutter) {
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

}  // namespace livery::assets
