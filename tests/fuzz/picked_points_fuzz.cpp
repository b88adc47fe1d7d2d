#include <cmath>

#include "calibration/registration/picked_points.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    for (const livery::MeshPick& one : livery::parse_picked_points(text, "points.csv")) {
        livery::fuzz::require(std::isfinite(one.mesh_mm.x) && std::isfinite(one.pixel.x) &&
                                  std::isfinite(one.pixel.y),
                              "finite");
        livery::fuzz::require(one.name.starts_with("line "), "a point says its line");
    }
}
