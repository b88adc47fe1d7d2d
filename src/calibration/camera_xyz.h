// From the camera's linear RGB to XYZ, for the light of this projector.
#pragma once

#include <glm/mat3x3.hpp>

#include "calibration/colour.h"
#include "calibration/mixing.h"

namespace livery {

/// Camera colours of full red, green, blue and white over black at one place.
struct CameraPrimaries {
    glm::dmat3 columns{0.0};
    glm::dvec3 white{0.0};
};

/// Least squares for red, green, blue and, where it was measured, white: exact without the latter.
/// Throws Refused when the camera cannot tell the primaries apart, or the measured ones are
/// singular.
glm::dmat3 xyz_from_primaries(const CameraToXyz& measured, const CameraPrimaries& camera);

}  // namespace livery
