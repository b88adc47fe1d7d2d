// The P3 approximation of a half space's diffuse reflectance: radiance inside by Legendre
// polynomials up to the third, from a point source and its image.
#pragma once

#include <array>

#include "appearance/subsurface/scattering_medium.h"

namespace livery {

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
