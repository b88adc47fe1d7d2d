// Photons through a half space, as a camera far away sees where they come out.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/subsurface/scattering_medium.h"
#include "core/progress.h"

namespace livery {

/// Squares of the surface z = 0 around the origin, `cells` a side.
struct SpotGrid {
    int cells = 1024;
    double half_width_mm = 20.0;
    double cell_mm() const { return 2.0 * half_width_mm / cells; }
};

/// Light that falls in a round Gaussian spot around the origin, from one direction.
struct PhotonSpot {
    double sigma_mm = 0.1;
    glm::dvec3 toward_light{0.0, 0.0, 1.0};  ///< unit length
    glm::dvec3 toward_eye{0.0, 0.0, 1.0};    ///< unit length
    std::uint64_t photons = 200'000;
    std::uint64_t seed = 1;
};

/// Radiance toward the eye of each square, row by row from (-x, -y), per unit power that enters:
/// per mm^2 and sr. The medium fills z < 0. Every scattering sends the eye what gets there
/// straight, by phase function, absorption, Fresnel and the widening of the beam, so that nothing
/// is assumed of how light leaves. The same for the same seed on any number of threads. Throws
/// Cancelled.
std::vector<float> spot_radiance(const ScatteringMedium& medium,
                                 const SpotGrid& grid,
                                 const PhotonSpot& spot,
                                 const Progress& progress = {});

/// Share of unpolarised light that a boundary mirrors, met at this cosine from outside of a medium
/// of this index; `within` gets the cosine of what goes on inside.
double mirrored_outside(double cosine, double eta, double& within);

}  // namespace livery
