#include <cmath>

#include "panel_cutter.h"

namespace livery::assets {

void cut_ends(const Cutter& cutter) {
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

}  // namespace livery::assets
