// From the camera's linear RGB to XYZ, for the light of this projector.
#pragma once

#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/colour/mixing.h"
#include "calibration/settings.h"
#include "scene/colour_calibration.h"

namespace livery {

/// Camera colours of full red, green, blue and white over black at one place.
struct CameraPrimaries {
    glm::dmat3 columns{0.0};
    glm::dvec3 white{0.0};
    glm::dvec3 black{0.0};  ///< of the dark picture itself
};

/// Averaged over the neighbourhood of `place`, whose mean is its middle's; without a place, over
/// the pixels of middling brightness. `share_of_channel`: N of each channel alone at full drive.
/// Throws Refused when no valid pixel lies there.
CameraPrimaries primaries_at(const ColourSamples& samples,
                             const PixelMixing& mixing,
                             const std::vector<PixelStatus>& status,
                             const glm::dvec3& share_of_channel,
                             const std::optional<glm::dvec2>& place);

/// The room's light is no mix of the projector's primaries: through the projector's matrix its
/// camera colour gives another XYZ than the colorimeter read. Replaces each pixel's dark by the
/// projector colour that looks like it, in proportion to the pixel's own dark.
void match_black(const CameraToXyz& measured,
                 const CameraPrimaries& camera,
                 const glm::dmat3& xyz_from_camera,
                 PixelMixing& mixing);

/// Least squares for red, green, blue and, where it was measured, white: exact without the latter.
/// Throws Refused when the camera cannot tell the primaries apart, or the measured ones are
/// singular.
glm::dmat3 xyz_from_primaries(const CameraToXyz& measured, const CameraPrimaries& camera);

}  // namespace livery
