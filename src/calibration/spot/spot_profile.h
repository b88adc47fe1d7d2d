// What comes back around a spot of light on a translucent sample -> its radial profile.
#pragma once

#include <vector>

#include "appearance/subsurface/radial_profile.h"
#include "calibration/spot/spot_of_light.h"

namespace livery {

/// What turns radiance into R_d.
struct SpotOptics {
    double eta = 1.5;               ///< the sample's index over that of air
    double incidence_cosine = 1.0;  ///< of the projector's light to the normal
    glm::dvec3 white_albedo{1.0};   ///< the reference's, RGB
};

/// Share of light from outside that a boundary lets through, mean over Lambert's directions: what
/// leaves a medium of even radiance within, over what would without a boundary.
double mean_transmittance(double eta);

/// Angle to the normal at which what leaves is as strong, over what the boundary lets through, as
/// in the mean over all directions, however radiance below changes with the cosine, to first order:
/// light from deep down favours the normal, light from near the surface does not.
double mean_view_rad(double eta);

/// One channel's.
struct SpotProfile {
    std::vector<ProfileSample> samples;   ///< mean over each ring, per mm^2 and power that enters
    std::vector<double> standard_errors;  ///< of those, from the differences between its eighths
    std::vector<std::size_t> pixels;      ///< in the ring
    double spot_mm = 0.0;                 ///< diameter of the disc that holds half of the spot
    /// Radius within which half of what comes back within the last ring does so.
    double half_energy_radius_mm = 0.0;
    double total_reflectance = 0.0;  ///< within the last ring, of what enters
    std::size_t clipped_rings = 0;   ///< left out: over a tenth of it saturated
    std::size_t doubtful_rings = 0;  ///< left out: hardly over noise, or uneven
    bool ends_in_noise = false;      ///< else at the picture's edge
};

/// Rings of a sixteenth of their radius, a pixel or more, from one and a half spots (nearer, the
/// profile is the spot's) to where the picture ends or three in a row do not rise over noise: the
/// mean under three times what its pixels' differences leave open. Left out, too: under twice its
/// standard error. Throws Refused: the sample saturated where the spot is, no light, fewer than six
/// rings, a spot wider than a third of `half_energy_radius_mm`.
SpotProfile spot_profile(const PlanePixels& pixels,
                         const ImageF& sample,
                         const SpotOfLight& spot,
                         int channel,
                         const SpotOptics& optics);

}  // namespace livery
