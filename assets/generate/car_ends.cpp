#include <algorithm>
#include <cmath>
#include <functional>

#include "panel_cutter.h"
#include "refine.h"

namespace livery::assets {

namespace {

/// Depth of a bowl below the skin: steep just inside its outline, then level.
std::function<double(const LimitVertex&)> bowl(const Outline& outline,
                                               glm::dvec2 (*view)(const LimitVertex&),
                                               double depth_mm,
                                               double wall_mm) {
    return [outline, view, depth_mm, wall_mm](const LimitVertex& v) {
        const double t = std::clamp(-outline.signed_distance(view(v)) / wall_mm, 0.0, 1.0);
        return depth_mm * t * (2.0 - t);
    };
}

/// The whole outline of something symmetric, from its right half.
Outline both_sides(const Points& right, double radius) {
    Points all = right;
    for (auto p = right.rbegin(); p != right.rend(); ++p) {
        if (p->x > 0.0) all.emplace_back(-p->x, p->y);
    }
    return Outline(all, radius);
}

/// Both head lamps and the band that joins them.
const Outline& head_bowl() {
    static const Outline outline = both_sides({{0.0, 26.7},
                                               {14.8, 27.3},
                                               {23.0, 28.7},
                                               {31.0, 30.3},
                                               {43.2, 33.2},
                                               {42.6, 31.5},
                                               {31.0, 26.8},
                                               {23.0, 25.0},
                                               {16.4, 24.8},
                                               {14.0, 25.6},
                                               {0.0, 25.2}},
                                              0.8);
    return outline;
}
const Outline& tail_bowl() {
    static const Outline outline({{-43.2, 42.15},
                                  {-30.0, 42.9},
                                  {0.0, 43.3},
                                  {30.0, 42.9},
                                  {43.2, 42.15},
                                  {42.6, 40.5},
                                  {30.0, 38.3},
                                  {20.0, 39.0},
                                  {0.0, 40.2},
                                  {-20.0, 39.0},
                                  {-30.0, 38.3},
                                  {-42.6, 40.5}},
                                 0.8);
    return outline;
}
const Outline& intake() {
    static const Outline outline(
        {{-14.0, 18.6}, {14.0, 18.6}, {20.0, 12.4}, {19.4, 9.6}, {-19.4, 9.6}, {-20.0, 12.4}}, 1.4);
    return outline;
}
const Outline& air_curtain() {
    static const Outline outline({{23.0, 20.6}, {27.6, 22.0}, {29.4, 11.6}, {24.6, 10.8}}, 1.0);
    return outline;
}
const Outline& plate() {
    static const Outline outline({{-10.6, 35.6}, {10.6, 35.6}, {11.4, 29.8}, {-11.4, 29.8}}, 0.9);
    return outline;
}
const Outline& diffuser() {
    static const Outline outline(
        {{-27.0, 9.9}, {-27.0, 12.4}, {-21.0, 17.6}, {21.0, 17.6}, {27.0, 12.4}, {27.0, 9.9}}, 0.9);
    return outline;
}

constexpr double kLampWall_mm = 0.5, kIntakeWall_mm = 0.6;

}  // namespace

void cut_ends(const Cutter& cutter) {
    const TriangleMask in_front = [&](const SheetTriangle& t) { return cutter.centre(t).x > 58.0; };
    const TriangleMask behind = [&](const SheetTriangle& t) { return cutter.centre(t).x < -58.0; };
    // A bowl has rings of edges where its wall begins and ends.
    const auto bowl_in = [&](const Outline& outline,
                             Cutter::View view,
                             double wall_mm,
                             Panel panel,
                             const TriangleMask& where,
                             bool fine) {
        constexpr double kAround_mm = 0.4;
        refine(cutter.sheet, [&](const SheetTriangle& t) {
            if (!fine || !where(t)) return false;
            LimitVertex at;
            at.position = cutter.centre(t);
            return outline.signed_distance(view(at)) < kAround_mm;
        });
        cutter(outline, view, 0.0, {kFenders}, panel, where);
        for (const double part : {0.3, 1.0}) {
            cutter(outline, view, -part * wall_mm, {panel}, panel, where);
        }
    };

    bowl_in(head_bowl(), nose_view, kLampWall_mm, kHeadBowl, in_front, true);
    // A blade of light under the bowl's upper edge, and three square projectors.
    const Outline blade = both_sides({{0.0, 26.2},
                                      {15.0, 26.75},
                                      {23.0, 28.0},
                                      {31.0, 29.55},
                                      {41.6, 32.0},
                                      {40.6, 31.2},
                                      {31.0, 28.65},
                                      {23.0, 27.15},
                                      {15.0, 26.15},
                                      {0.0, 25.75}},
                                     0.3);
    cutter(blade, nose_view, 0.0, {kHeadBowl}, kHeadLamp, in_front);
    for (const double at : {20.2, 24.4, 28.6}) {
        const double y = 25.45 + 0.055 * (at - 20.0) + 0.004 * (at - 20.0) * (at - 20.0);
        const Outline projector({{at - 1.5, y + 1.0 - 0.1},
                                 {at + 1.5, y + 1.0 + 0.25},
                                 {at + 1.3, y - 0.35 + 0.2},
                                 {at - 1.3, y - 0.35}},
                                0.3);
        cutter(projector, nose_view, 0.0, {kHeadBowl}, kHeadLamp, in_front);
    }

    bowl_in(intake(), nose_view, kIntakeWall_mm, kIntake, in_front, false);
    // Blades between the intake's walls.
    for (const double y : {11.3, 13.1, 14.9, 16.7}) {
        double half = 0.0;
        while (intake().signed_distance({half, y - 0.4}) < -kIntakeWall_mm - 0.1 &&
               intake().signed_distance({half, y + 0.4}) < -kIntakeWall_mm - 0.1) {
            half += 0.1;
        }
        const Outline slat({{-half, y + 0.4}, {half, y + 0.4}, {half, y - 0.4}, {-half, y - 0.4}},
                           0.1);
        cutter(slat, nose_view, 0.0, {kIntake}, kIntakeBlade, in_front);
    }
    bowl_in(air_curtain(), nose_view, kIntakeWall_mm, kAirCurtain, in_front, false);

    bowl_in(tail_bowl(), tail_view, kLampWall_mm, kTailBowl, behind, true);
    const Outline bar({{-42.0, 41.6},
                       {-30.0, 42.1},
                       {0.0, 42.3},
                       {30.0, 42.1},
                       {42.0, 41.6},
                       {41.0, 41.0},
                       {30.0, 41.1},
                       {0.0, 41.3},
                       {-30.0, 41.1},
                       {-41.0, 41.0}},
                      0.3);
    cutter(bar, tail_view, 0.0, {kTailBowl}, kTailLamp, behind);
    for (const double at : {26.2, 30.4, 34.6}) {
        const Outline block(
            {{at - 1.6, 40.35}, {at + 1.6, 40.35}, {at + 1.9, 39.3}, {at - 1.3, 39.3}}, 0.25);
        cutter(block, tail_view, 0.0, {kTailBowl}, kTailLamp, behind);
    }
    bowl_in(plate(), tail_view, kIntakeWall_mm, kPlateRecess, behind, true);
    bowl_in(diffuser(), tail_view, kIntakeWall_mm, kDiffuser, behind, false);
    for (const double at : {3.6, 10.2, 16.4}) {
        const Outline fin({{at - 0.5, 16.8}, {at + 0.5, 16.8}, {at + 0.5, 10.5}, {at - 0.5, 10.5}},
                          0.1);
        cutter(fin, tail_view, 0.0, {kDiffuser}, kDiffuserFin, behind);
    }
}

void style_ends(std::vector<PanelStyle>& styles) {
    const auto sunk = [&](Panel panel,
                          CarPart part,
                          const Outline& outline,
                          Cutter::View view,
                          double depth_mm,
                          double wall_mm) {
        styles[panel] = {part, 0.0, 0.12, 0.4, bowl(outline, view, depth_mm, wall_mm)};
    };
    constexpr double kLampDepth_mm = 1.1, kIntakeDepth_mm = 2.2, kDiffuserDepth_mm = 1.2;
    sunk(kHeadBowl, kTrim, head_bowl(), nose_view, kLampDepth_mm, kLampWall_mm);
    sunk(kTailBowl, kTrim, tail_bowl(), tail_view, kLampDepth_mm, kLampWall_mm);
    sunk(kIntake, kTrim, intake(), nose_view, kIntakeDepth_mm, kIntakeWall_mm);
    sunk(kAirCurtain, kTrim, air_curtain(), nose_view, kIntakeDepth_mm, kIntakeWall_mm);
    sunk(kPlateRecess, kBody, plate(), tail_view, 0.7, kIntakeWall_mm);
    sunk(kDiffuser, kTrim, diffuser(), tail_view, kDiffuserDepth_mm, kIntakeWall_mm);
    styles[kHeadLamp] = {kLights, 0.45, 0.0, 0.4};
    styles[kTailLamp] = {kLights, 0.4, 0.0, 0.4};
    styles[kIntakeBlade] = {kTrim, 0.5, 0.0, kIntakeDepth_mm - 0.7};
    styles[kDiffuserFin] = {kTrim, 0.0, 0.0, kDiffuserDepth_mm - 0.2};
}

}  // namespace livery::assets
