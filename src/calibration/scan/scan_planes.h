// Tables and walls, told from the product and taken out of a scan.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/scan/scan.h"

namespace livery {

/// normal . x = offset in the scan's frame; the normal points to where the product stands.
struct RemovedPlane {
    glm::dvec3 normal{0.0, 1.0, 0.0};
    double offset_mm = 0.0;
    double rms_mm = 0.0;     ///< of the points on it
    std::size_t points = 0;  ///< taken out on it, with what it left of itself in small pieces
    std::size_t behind = 0;  ///< taken out behind it
};

struct RemovedPlanes {
    std::vector<RemovedPlane> planes;  ///< the largest first
    /// Points that are left beside a plane: farther off than four deviations, nearer than twelve.
    std::size_t beside = 0;
    std::vector<std::string> warnings;
};

/// Takes the `count` largest planes and what lies behind them out of the scan. A point is on a
/// plane when it lies within four of its own deviations across it, or as many times more as the
/// plane's points scatter more than theirs say. Small pieces that nowhere stand out of twelve of
/// them go as well. What hangs together with points behind it is a side of something and no wall,
/// and what leaves hardly anything before it is the product: such planes are passed over, and a
/// warning says when there are fewer than `count`.
RemovedPlanes remove_planes(Scan& scan, int count);

}  // namespace livery
