#include <algorithm>

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
    const Outline doors({{33.6, 36.0},
                         {31.6, 41.0},
                         {22.0, 46.0},
                         {0.0, 70.0},
                         {-41.6, 70.0},
                         {-41.2, 41.0},
                         {-40.4, 34.6},
                         {-37.6, 28.0},
                         {-35.6, 18.0},
                         {-35.0, 11.9},
                         {31.0, 11.0},
                         {33.4, 14.4},
                         {34.2, 26.0}},
                        2.0);
    const TriangleMask under_window = [&](const SheetTriangle& t) {
        return on_side(t) && cutter.row(t) > 5.6;
    };
    cutter(doors, side_view, 0.0, {kFenders}, kRearDoor, under_window);
    cutter.along([](const LimitVertex& v) { return behind_pillar_mm(v); },
                 {kRearDoor},
                 kFrontDoor,
                 under_window);
    for (const double x : {-2.6, -33.6}) {
        const double y = x > -20 ? 36.0 : 36.8;
        const Outline handle(
            {{x - 3.7, y + 0.62}, {x + 3.7, y + 0.52}, {x + 3.7, y - 0.52}, {x - 3.7, y - 0.42}},
            0.6);
        cutter(handle, side_view, 0.0, {kFrontDoor, kRearDoor}, kDoorHandle, on_side);
    }

    Points bonnet;
    for (double row = 0.0; row < 4.5; row += 0.5) bonnet.push_back(along_lines(16.12, row));
    for (double station = 16.12; station < 22.0; station += 0.5) {
        bonnet.push_back(along_lines(station, 4.55));
    }
    bonnet.push_back(along_lines(22.6, 3.9));
    for (double row = 3.0; row > 0.0; row -= 0.5) bonnet.push_back(along_lines(22.9, row));
    bonnet.push_back(along_lines(22.9, 0.0));
    cutter(Outline(mirrored(bonnet), 1.8), line_view, 0.0, {kFenders}, kBonnet, on_top);
    Points hatch;
    for (double row = 0.0; row < 3.3; row += 0.5) hatch.push_back(along_lines(6.2, row));
    hatch.push_back(along_lines(6.2, 3.3));
    hatch.push_back(along_lines(3.0, 3.5));
    hatch.push_back(along_lines(1.4, 4.9));
    hatch.push_back(along_lines(-1.0, 5.2));
    hatch.push_back(along_lines(-1.0, 0.0));
    cutter(Outline(mirrored(hatch), 1.8), line_view, 0.0, {kFenders}, kHatch, on_top);
    const Outline lower_hatch({{-23.6, 60.0}, {-22.6, 15.0}, {22.6, 15.0}, {23.6, 60.0}}, 2.0);
    cutter(lower_hatch, end_view, 0.0, {kFenders}, kHatch, [&](const SheetTriangle& t) {
        return t.region == kTail;
    });
    // The front bumper ends at the wheel arch, under the lamp and beside the bonnet's front corner.
    const auto bumper = [](const LimitVertex& v) {
        const auto at = nose_view(v);
        const double behind = 66.4 + 0.15 * (32.0 - v.position.y) - v.position.x;
        const double above_lamp = at.y - 26.2 - 0.24 * (at.x - 15.0);
        return std::max(behind, std::min(above_lamp, at.x - 19.6));
    };
    cutter.along(bumper, {kFenders}, kFrontBumper, [&](const SheetTriangle& t) {
        return cutter.centre(t).x > 56.0;
    });
    cutter.along([](const LimitVertex& v) { return v.position.y - 23.4; },
                 {kFenders, kHatch},
                 kRearBumper,
                 [&](const SheetTriangle& t) { return cutter.centre(t).x < -58.0; });
}

}  // namespace livery::assets
