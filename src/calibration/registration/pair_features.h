// Where a product may stand in a scan, from no starting value.
#pragma once

#include <vector>

#include "calibration/registration/surface_samples.h"
#include "scene/view.h"

namespace livery {

struct PoseGuess {
    Rigid3 scan_from_mesh;
    double votes = 0.0;
};

/// Poses by voting of oriented point pairs (Drost, Ulrich, Navab, Ilic: "Model globally, match
/// locally", CVPR 2010): each pair of scan samples whose distance and angles are those of a pair
/// of the mesh votes for the pose that lays one over the other. Both sides about `spacing_mm`
/// apart. Poses alike (15 degrees, 3 spacings) are one; the best `most`, by votes. What is not of
/// the product (a table, a hand) makes votes that do not add up.
std::vector<PoseGuess> poses_by_pairs(const SurfaceSamples& mesh,
                                      const SurfaceSamples& scan,
                                      double spacing_mm,
                                      std::size_t most);

}  // namespace livery
