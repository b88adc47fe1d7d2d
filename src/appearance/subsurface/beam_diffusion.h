// Photon beam diffusion (Habel, Christensen and Jarosz 2013): the improved diffusion of a source at
// each depth of the beam, without what scattered once.
#pragma once

#include <vector>

#include "appearance/subsurface/diffusion.h"

namespace livery {

/// A narrow beam's sources between two reduced depths: these, and the power each stands for.
struct BeamDepths {
    std::vector<double> reduced_depths, powers;
};
/// In panels that grow with the depth, down to where nothing is left of the beam: what is near the
/// surface shapes the profile near the beam.
BeamDepths beam_depths(double from, double to);

class BeamDiffusion {
  public:
    explicit BeamDiffusion(const ScatteringMedium& medium);

    /// Per mm^2 at this distance from the beam, above 0, per unit power that enters.
    Exitance at(double radius_mm) const;
    /// Over the whole plane, by quadrature over the radius.
    Exitance total() const;

  private:
    double sigma_t_prime_;
    std::optional<double> thickness_;
    std::vector<double> powers_;
    PointSources sources_;
};

}  // namespace livery
