// A homogeneous translucent medium: what light meets in it, at its boundary, and what follows from
// that.
#pragma once

#include <array>
#include <optional>

namespace livery {

/// What files may say: more is no medium, and 1 - g stays a number that can be divided by.
inline constexpr double kLargestCoefficient_per_mm = 1e6, kThickest_mm = 1e6, kLargestG = 0.9999;

/// Air lies outside. Without a thickness it is a half space, else a slab with air on both sides.
struct ScatteringMedium {
    double sigma_a_per_mm = 0.0;  ///< absorption
    double sigma_s_per_mm = 0.0;  ///< scattering
    double g = 0.0;               ///< mean cosine of Henyey and Greenstein's phase function
    double eta = 1.5;             ///< index of refraction over that of air
    std::optional<double> thickness_mm;

    double sigma_t() const { return sigma_a_per_mm + sigma_s_per_mm; }
    /// Isotropic scattering that spreads light as far (similarity relation).
    double sigma_s_prime() const { return sigma_s_per_mm * (1.0 - g); }
    double sigma_t_prime() const { return sigma_a_per_mm + sigma_s_prime(); }
    /// sigma_s'/sigma_t'; 0 where nothing is met.
    double albedo_prime() const;
    /// 1/sigma_t', the unit of the models' accuracy; infinite where nothing is met.
    double mean_free_path_mm() const { return 1.0 / sigma_t_prime(); }
    /// sigma_t' times the thickness; infinite for a half space.
    double reduced_depth() const;
};

/// What of the light never scatters, per unit power that arrives (specular) or enters (the others).
struct UnscatteredLight {
    double specular = 0.0;     ///< reflected by the surface before it enters
    double transmitted = 0.0;  ///< through the slab, with what the surfaces throw to and fro
    double reflected = 0.0;    ///< back out of the top after a mirror reflection at the bottom
};
UnscatteredLight unscattered_light(const ScatteringMedium& medium);

/// The smallest radius at which a profile is evaluated, a thousandth of a mean free path: profiles
/// go as 1/r below, and what is asked for within is the mean over the disc of this radius.
double least_radius_mm(const ScatteringMedium& medium);

/// Throws std::invalid_argument that names the quantity, what was found and what was expected:
/// coefficients from 0 to 1e6 per mm, g within -1 and 1, eta .5 to 4, a thickness above 0.
void check_medium(const ScatteringMedium& medium);

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
