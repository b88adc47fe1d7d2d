// The room seen from above: what a plan shows, and where in it a seat may be put. Values without a
// window. to the right is +x, down is +z, millimetres of the world.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "mesh/mesh.h"
#include "scene/seats.h"
#include "scene/view.h"

namespace livery {

/// Where a point of the world lies in the plan.
inline glm::dvec2 in_plan(const glm::dvec3& x_in_world) { return {x_in_world.x, x_in_world.z}; }

/// The convex hull of the mesh from above, in order round it.
std::vector<glm::dvec2> outline_from_above(const Mesh& mesh);

/// From a point to the outline; negative inside. `nearest` is the point on it.
struct OutlineDistance {
    double mm = 0.0;
    glm::dvec2 nearest_mm{0.0};
};
OutlineDistance distance_to_outline(const std::vector<glm::dvec2>& outline, const glm::dvec2& at);

/// What of the room is shown: a rectangle of this shape (width over height) round everything.
struct PlanExtent {
    glm::dvec2 low_mm{0.0}, high_mm{0.0};
};
PlanExtent plan_extent(const std::vector<glm::dvec2>& points_mm, double aspect);

/// Where the rays through the left and right middle of a view's picture lead, in the plan, as far
/// as `reach_mm`; nothing for a lens without such rays.
struct PlanCone {
    glm::dvec2 from_mm{0.0}, left_mm{0.0}, right_mm{0.0};
};
std::optional<PlanCone> cone_in_plan(const View& view, double reach_mm);

/// Of 1, 2, 5, 10, ... mm, the longest bar that is no longer than this.
double scale_bar_mm(double longest_mm);
/// "500 mm", "2 m".
std::string length_in_words(double mm);

inline constexpr double kSeatStep_mm = 10.0;          ///< a seat that is dragged stands on these
inline constexpr double kLeastFromMockup_mm = 150.0;  /// of an eye, in the plan

/// Where a seat is put that somebody wants at a point of the plan: not outside of it, not over the
/// mock-up, not on another seat; `why` says what kept it from where it was wanted.
struct PlacedSeat {
    glm::dvec3 eye_mm{0.0};
    std::string why;
};
PlacedSeat placed_seat(const EyeSeat& seat,
                       const glm::dvec2& wanted_mm,
                       const std::vector<EyeSeat>& seats,
                       const std::vector<glm::dvec2>& outline,
                       const PlanExtent& extent);

}  // namespace livery
