// Colours of a calibration taken along with a mock-up that stands elsewhere now.
#pragma once

#include "core/progress.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/view.h"

namespace livery {

/// A projector and a camera with the product's frame for their world.
struct PairOfViews {
    View projector, camera;
};

/// Each projector pixel of now lights a place of the mesh, which other pixels lit then: their
/// unmixing and dark, and their span over the irradiance that they threw there (cos(theta) /
/// distance^2) times that of now, between those of the four that were measured and lit the same
/// surface; half of the weight at least. What only saw light of its own room keeps it: the dark is
/// not scaled. What nothing is carried to is predicted as predict_hidden() does, or without a
/// correction. Off the mesh all stays as it was. The projector's own vignetting between two places
/// some pixels apart is not looked at. Sealed anew. Throws std::invalid_argument for views of
/// another size than the calibration.
ColourCalibration carry_colours(const ColourCalibration& then,
                                const Mesh& mesh,
                                const PairOfViews& views_then,
                                const PairOfViews& views_now,
                                const Progress& progress = {});

}  // namespace livery
