// What the car's cuts share: the panels, the views that outlines are drawn in, and the knife.
#pragma once

#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "car_panels.h"
#include "outline.h"
#include "sheet.h"

namespace livery::assets {

enum Panel {
    kFenders,  // what is left of the skin: front fenders, roof sides, rear quarters
    kWindscreen,
    kRearScreen,
    kFrontSideGlass,
    kRearSideGlass,
    kQuarterGlass,
    kWindowFrame,
    kBonnet,
    kHatch,
    kFrontDoor,
    kRearDoor,
    kFrontBumper,
    kRearBumper,
    kHeadLamp,  // what shines in the lamps' bowls
    kTailLamp,
    kHeadBowl,
    kTailBowl,
    kIntake,
    kIntakeBlade,
    kAirCurtain,
    kDiffuser,
    kDiffuserFin,
    kPlateRecess,
    kLowerTrim,
    kDoorHandle,
    kUnderbody,
    kPanels,
};

using Points = std::vector<glm::dvec2>;

// Views of a vertex: from the side (x, y), from above (x, z), from an end (z, y), developed around
// an upright axis in the nose or the tail (arc at 40 mm, y), and along the feature lines (stations
// and rows as nominal millimetres, see along_lines).
glm::dvec2 side_view(const LimitVertex& v);
glm::dvec2 top_view(const LimitVertex& v);
glm::dvec2 end_view(const LimitVertex& v);
glm::dvec2 nose_view(const LimitVertex& v);
glm::dvec2 tail_view(const LimitVertex& v);
glm::dvec2 line_view(const LimitVertex& v);

/// A station and a row as coordinates of line_view: an outline between two rows keeps its distance
/// from both.
glm::dvec2 along_lines(double station, double row);

/// A point of the feature lines from the side.
glm::dvec2 side_of(double station, double row);

/// Both halves of an outline that crosses the centre line, from its points with z >= 0.
Points mirrored(const Points& half);

/// How far a point lies behind the line between the doors, which leans back above the belt and
/// forward below.
double behind_pillar_mm(const LimitVertex& v);

struct Cutter {
    Sheet& sheet;

    using View = glm::dvec2 (*)(const LimitVertex&);

    /// Panels in `from` become `to` inside the outline moved outward by `offset`.
    void operator()(const Outline& outline,
                    View view,
                    double offset,
                    const std::vector<int>& from,
                    int to,
                    const TriangleMask& where) const;
    /// The same where f is negative.
    void along(const CutFunction& f,
               const std::vector<int>& from,
               int to,
               const TriangleMask& where) const;

    glm::dvec3 centre(const SheetTriangle& t) const;
    double row(const SheetTriangle& t) const;
};

void cut_windows(const Cutter& cutter);
/// Lamps, grille, intakes, diffuser.
void cut_ends(const Cutter& cutter);
void style_ends(std::vector<PanelStyle>& styles);
/// Doors and their handles, bonnet, hatch, bumpers.
void cut_lids(const Cutter& cutter);

}  // namespace livery::assets
