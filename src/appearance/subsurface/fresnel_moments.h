// What a dielectric boundary reflects of light that meets it from inside.
#pragma once

#include <array>

namespace livery {

/// Fresnel's unpolarised reflectance for a ray inside a medium of index `eta` (over that outside)
/// at the cosine `mu` to the normal; 1 beyond the critical angle.
double inner_reflectance(double eta, double mu);

/// Cosine of the critical angle inside; 0 where all angles get out (eta up to 1).
double critical_cosine(double eta);

struct FresnelMoments {
    double c1 = 0.0;                 ///< integral of F mu over mu from 0 to 1
    double c2 = 0.0;                 ///< integral of F mu^2
    std::array<double, 4> passed{};  ///< integrals of (1 - F) mu P_l, l = 0 to 3
};
/// By quadrature on both sides of the critical angle, where published polynomials are off, and do
/// not vanish for eta 1.
FresnelMoments fresnel_moments(double eta);

}  // namespace livery
