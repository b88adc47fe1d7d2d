// One half of a smooth skin (z >= 0), cut into panels along curves, then given gaps and depth.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "part_mesh.h"
#include "subdivision.h"

namespace livery::assets {

struct SheetTriangle {
    glm::uvec3 corners{0};
    int panel = 0;
    int region = 0;
};

struct Sheet {
    std::vector<LimitVertex> vertices;
    std::vector<SheetTriangle> triangles;
};

inline constexpr int kNoPanel = -1;  ///< cut away

/// The z >= 0 half of a symmetric limit mesh, all in panel 0.
Sheet half_sheet(const LimitMesh& mesh);

/// The vertex, its place and what it carries -> signed value, negative inside.
using CutFunction = std::function<double(const LimitVertex&)>;
using TriangleMask = std::function<bool(const SheetTriangle&)>;
using Relabel = std::function<int(int panel)>;

/// Splits masked triangles along f = 0 and gives those inside a new panel. Vertices that lie close
/// to the curve are moved onto it along their edges, so that no slivers arise; vertices on earlier
/// cuts move only along these.
void cut(Sheet& sheet, const CutFunction& f, const TriangleMask& mask, const Relabel& relabel);

/// How a panel is built from the skin.
struct PanelStyle {
    int part = 0;           ///< index into the parts
    double inset_mm = 0.0;  ///< below the skin
    double gap_mm = 0.0;    ///< width of the joint around it, shared with the neighbour
    double wall_mm = 0.5;   ///< its thickness; its edge reaches below a deeper neighbour too
    /// More depth below the skin, over the panel, 0 or more and 0 at its border; null: none. Such a
    /// panel is shaded by its own faces, with corners over 40 degrees sharp.
    std::function<double(const LimitVertex&)> relief_mm = nullptr;
    bool is_coarse = false;  ///< its outer face need not keep all its triangles
};

/// Chart coordinates (before scaling) of a vertex in a region.
using ChartFunction = std::function<glm::dvec2(const LimitVertex&, int region)>;

/// Appends each panel to its part as a closed solid, and to part `joint_part` a dark closed band
/// that lies below all joints. Both get thinner where the skin bends tightly.
void build_panels(const Sheet& sheet,
                  const std::vector<PanelStyle>& styles,
                  const ChartFunction& chart,
                  int joint_part,
                  std::vector<PartMesh>& parts);

}  // namespace livery::assets
