// Turns that leave a product as it is.
#pragma once

#include <optional>
#include <vector>

#include "calibration/registration/surface_samples.h"
#include "scene/view.h"

namespace livery {

/// A turn or shift that moves surfaces along their normals by less than this share of the way is
/// one that shape does not fix.
inline constexpr double kSlipsFreely = 0.03;

/// About which axes a product turns without changing: none, one (a surface of revolution, its axis
/// given) or all (a sphere).
struct FreeTurns {
    int count = 0;  ///< 0, 1 or 3
    glm::dvec3 axis{0.0, 1.0, 0.0};
    glm::dvec3 through_mm{0.0};  ///< a point of the axis; the centre of the sphere
};

/// From how far the surface slips along itself (Gelfand and Guibas, "Shape segmentation using local
/// slippage analysis", 2004): a turn is free that moves it by less than 3% of the way along its
/// normals (root mean square). The samples count as means over cells of that side: a scan's
/// roughness is no shape.
FreeTurns free_turns(const SurfaceSamples& samples, double cell_mm);

/// Whether a motion lays the surface over itself: 99% of the samples within `within_mm` of others.
bool maps_onto_itself(const SurfaceSamples& mesh,
                      const NearestSample& tree,
                      const Rigid3& motion,
                      double within_mm);

/// Two poses that differ by a free turn, apart from `angle_rad` and `shift_mm`, are one.
bool same_pose(const Rigid3& a_from_mesh,
               const Rigid3& b_from_mesh,
               const FreeTurns& free,
               const glm::dvec3& middle_mm,
               double angle_rad,
               double shift_mm);

}  // namespace livery
