// Iterative closest points: a guess made exact on samples.
#pragma once

#include "calibration/registration/nearest_sample.h"
#include "calibration/registration/surface_samples.h"
#include "scene/view.h"

namespace livery {

struct Aligned {
    Rigid3 scan_from_mesh;
    double rms_mm = 0.0;      ///< of the inliers' distances from the mesh's planes
    std::size_t inliers = 0;  ///< scan samples
};

/// Point to plane (Chen and Medioni 1992), trimmed: a scan sample counts while its nearest mesh
/// sample is within a reach that shrinks from `from_mm` to `to_mm`, and faces the same way; less
/// the farther off its plane it is (Tukey). `tree` is of mesh.points.
Aligned closest_points(const SurfaceSamples& mesh,
                       const NearestSample& tree,
                       const SurfaceSamples& scan,
                       const Rigid3& scan_from_mesh,
                       double from_mm,
                       double to_mm,
                       int iterations);

}  // namespace livery
