// Models of the light that leaves a half space beside where it entered: normalised diffusion,
// photon beam diffusion, and the P3 approximation.
#pragma once

#include <array>
#include <vector>

#include "appearance/subsurface/diffusion.h"
#include "appearance/subsurface/scattering_medium.h"

namespace livery {

/// For a beam along the normal: A (e^{-r/d} + e^{-r/3d})/(8 pi d r), d = (mean free path)/s, with
/// s = 1.85 - A + 7 |A - .8|^3. Fitted without a step of the index at the boundary.
struct NormalizedDiffusion {
    NormalizedDiffusion(double total_reflectance, double mean_free_path_mm);

    double at(double radius_mm) const;  ///< per mm^2, above 0
    double total() const { return albedo; }
    /// Share within the radius.
    double cumulative(double radius_mm) const;

    double albedo, d_mm;
};

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

/// Needs sigma_s above 0. Stays finite where nothing is absorbed, and is negative in places where
/// the albedo is low: the caller's to notice.
class P3Dipole {
  public:
    explicit P3Dipole(const ScatteringMedium& medium);

    double at(double radius_mm) const;  ///< per mm^2 and unit power that enters
    double total() const;               ///< over the plane, in closed form

  private:
    struct Root {
        double nu = 0.0;  ///< decay, per mm
        double strength = 0.0;
        /// G_l/nu^l: what the moment of degree l has of it.
        std::array<double, 4> moment{};
    };
    double moments_at(double depth, double radius) const;

    std::array<Root, 2> roots_{};
    std::array<double, 4> passed_{};
    double albedo_ = 0.0, depth_ = 0.0, image_depth_ = 0.0;
};

}  // namespace livery
