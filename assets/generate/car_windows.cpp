#include "car_cage.h"
#include "panel_cutter.h"

namespace livery::assets {

namespace {

/// The side windows as one opening between the cant rail and the belt.
Outline side_window() {
    return Outline({along_lines(15.05, 5.86),
                    along_lines(14.6, 4.42),
                    along_lines(12.0, 4.28),
                    along_lines(9.0, 4.24),
                    along_lines(6.0, 4.30),
                    along_lines(4.3, 4.62),
                    along_lines(3.1, 5.35),
                    along_lines(3.4, 5.72),
                    along_lines(5.0, 5.86)},
                   1.2);
}

}  // namespace

void cut_windows(const Cutter& cutter) {
    const auto on_side = [&](const SheetTriangle& t) {
        return t.region == kTop && cutter.row(t) > 3.3 && cutter.row(t) < 7.0;
    };
    const auto window = side_window();
    cutter(window, line_view, 0.0, {kFenders}, kWindowFrame, on_side);
    cutter(window, line_view, -0.75, {kWindowFrame}, kRearSideGlass, on_side);
    // The middle pillar and the bar behind the rear door part the glass; both lean back.
    const auto split = [&](double from_mm, double to_mm, Panel in_front) {
        const auto behind = [=](double at_mm) {
            return [=](const LimitVertex& v) { return behind_pillar_mm(v) - at_mm; };
        };
        cutter.along(behind(from_mm), {kRearSideGlass}, in_front, on_side);
        cutter.along(behind(to_mm), {kRearSideGlass}, kWindowFrame, on_side);
    };
    split(-0.9, 0.9, kFrontSideGlass);
    split(31.4, 32.4, kQuarterGlass);

    const auto on_top = [&](const SheetTriangle& t) {
        return t.region == kTop && cutter.row(t) < 3.9;
    };
    const auto across = [](double base, double top, double edge_row) {
        Points half;
        for (double row = 0.0; row < edge_row; row += 0.5) half.push_back(along_lines(base, row));
        half.push_back(along_lines(base, edge_row));
        half.push_back(along_lines(0.5 * (base + top), edge_row));
        half.push_back(along_lines(top, edge_row));
        half.push_back(along_lines(top, 0.0));
        return Outline(mirrored(half), 2.2);
    };
    // Each in a dark seal; the windscreen's is wide at the cowl.
    cutter(across(16.14, 12.54, 3.2), line_view, 0.0, {kFenders}, kWindowFrame, on_top);
    cutter(across(15.9, 12.6, 3.12), line_view, 0.0, {kWindowFrame}, kWindscreen, on_top);
    cutter(across(1.94, 5.96, 2.94), line_view, 0.0, {kFenders}, kWindowFrame, on_top);
    cutter(across(2.0, 5.9, 2.86), line_view, 0.0, {kWindowFrame}, kRearScreen, on_top);
}

}  // namespace livery::assets
