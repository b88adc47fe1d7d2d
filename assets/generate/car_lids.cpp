#include "car_cage.h"
#include "panel_cutter.h"

namespace livery::assets {

void cut_lids(const Cutter& cutter) {
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

}  // namespace livery::assets
