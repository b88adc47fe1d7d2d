// Light that has scattered often, from a point source in a half space or slab: the parts that the
// dipoles and multipoles are made of.
#pragma once

#include <vector>

#include "appearance/subsurface/exact_totals.h"

namespace livery {

/// A diffusion equation with its boundary condition and the way that light is taken to leave.
struct Diffusion {
    double coefficient_mm = 0.0;    ///< D
    double sigma_tr_per_mm = 0.0;   ///< sqrt(sigma_a/D)
    double extrapolation_mm = 0.0;  ///< z_b = 2 A D: where the fluence vanishes outside
    double fluence_share = 0.0;     ///< of the exitance, times the fluence
    double flux_share = 1.0;        ///< times the flux through the boundary
};

/// D = 1/(3 sigma_t'), A = (1 + 2 C1)/(1 - 2 C1), flux alone: Jensen et al. 2001, Donner and Jensen
/// 2005.
Diffusion classical_diffusion(const ScatteringMedium& medium);
/// Grosjean's D = (2 sigma_a + sigma_s')/(3 sigma_t'^2), A = (1 + 3 C2)/(1 - 2 C1), fluence and
/// flux: d'Eon and Irving 2011.
Diffusion improved_diffusion(const ScatteringMedium& medium);

/// What leaves at the top, and a slab's bottom.
struct Exitance {
    double reflected = 0.0, transmitted = 0.0;
};

/// Point sources at some depths in one medium, with their powers already spoken for.
class PointSources {
  public:
    PointSources(const Diffusion& diffusion,
                 std::optional<double> thickness_mm,
                 std::vector<double> depths_mm);

    /// Per mm^2 at this distance along the surface, from each source as if its power were 1. Pairs
    /// of images for short distances; where they would cancel, beyond a fifth of the slab, the sum
    /// over the slab's modes (K_0 of the distance each).
    void at(double radius_mm, std::vector<Exitance>& out) const;
    /// Over the whole plane, in closed form.
    Exitance total(std::size_t index) const;
    /// The decay of what is far away, per mm; 0 for a half space that absorbs nothing.
    double decay_per_mm() const;

    const std::vector<double>& depths_mm() const { return depths_; }

  private:
    Exitance half_space(double depth, double radius) const;
    Exitance images(double depth, double radius) const;

    Diffusion diffusion_;
    std::optional<double> thickness_;
    double period_;  ///< thickness + 2 z_b
    std::vector<double> depths_;
    std::vector<double> mode_exit_, mode_source_;  ///< of mode n; of source and mode
};

}  // namespace livery
