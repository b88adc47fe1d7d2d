// The simulated stand on which a spot of light on a translucent sample is photographed.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

#include "appearance/subsurface/scattering_medium.h"
#include "core/image.h"
#include "core/progress.h"
#include "twin/description.h"

namespace livery {

/// World: millimetres, the surface z = 0 with the spot around the origin, projector and camera
/// above.
struct SpotStand {
    CameraDescription camera;               ///< its lens and noise; its spectra are not used
    std::array<ScatteringMedium, 3> media;  ///< half spaces, for red, green and blue
    glm::dvec3 projector_mm{0.0, 0.0, 700.0};
    double spot_sigma_mm = 0.1;  ///< round, Gaussian
    double white = 0.95;         ///< the reference's albedo
    /// What each channel reads a second off a perfect white in the spot's middle.
    double units_per_s = 1e6;
    /// Light of the room and of the projector's black, over the spot's middle; a fifth stronger on
    /// one side of the picture than on the other.
    double room = 2e-4;
    std::uint64_t photons = 200'000;  ///< a channel
    std::uint64_t seed = 1;
};

/// A camera 600 mm away, 45 degrees off the normal and beside the plane of the projector's light,
/// which comes 5 degrees off it; the spot is well narrower than light spreads in these media, the
/// picture wide enough for what the second leaves of it. Noise, flare and encoding are those of
/// `camera`.
SpotStand usual_spot_stand(const CameraDescription& camera,
                           const std::array<ScatteringMedium, 3>& media,
                           int size_px);

/// What the camera sees, file units a second.
struct SpotScenes {
    ImageF sample, sample_black;  ///< with the spot; with the room's light alone
    ImageF white, white_black;
};
/// What the sample mirrors misses the camera. Throws Cancelled.
SpotScenes spot_scenes(const SpotStand& stand, const Progress& progress = {});

}  // namespace livery
