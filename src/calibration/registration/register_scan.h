// Where the mock-up stands, from what the camera sees of the projector's light on it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/registration/pixel_refinement.h"
#include "calibration/registration/scan_poses.h"
#include "calibration/registration/symmetry.h"
#include "calibration/scan/scan.h"
#include "core/progress.h"
#include "mesh/mesh.h"

namespace livery {

struct RegistrationOptions {
    LensPrior prior;
    /// Another place to begin with, besides those found from none: picked points, the last session.
    std::optional<Rigid3> start{};
    double least_agreement = 0.6;  ///< share of the mesh's expected pixels that the scan confirms
};

struct Registration {
    Rigid3 world_from_mesh;  ///< world of the views that were given; the mesh times mesh_scale
    PixelRefinement refined;
    PoseEvidence evidence;  ///< of the refined pose
    FreeTurns free;         ///< turns that the product leaves open
    /// Other poses in which the product looks the same because it is symmetric: turns of the mesh.
    std::vector<Rigid3> equal_motions;
    std::vector<std::string> warnings;
};

/// The pose of `mesh` by its scan, whatever it is turned to and whatever stands around: pair
/// features, iterative closest points, evidence pixel by pixel, refinement on pixels. All sights
/// have the projector in common. Throws Refused: too few pixels on the product, another product's
/// mesh, a mirrored mesh, two poses that fit alike though the product is not symmetric; and as
/// scan_of() and refine_on_pixels().
Registration register_scan(const Mesh& mesh,
                           const View& projector,
                           const std::vector<Sight>& sights,
                           const RegistrationOptions& options = {},
                           const Progress& progress = {});

}  // namespace livery
