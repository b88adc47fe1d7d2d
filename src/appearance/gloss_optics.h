// A glossmeter's black glass and the reflectance of interfaces, exactly.
#pragma once

namespace livery {

/// Of polished black glass, the standard's 100.
inline constexpr double kGlossStandardIndex = 1.567;

/// Share of unpolarised light that a smooth interface of that index throws back (Fresnel).
double dielectric_reflectance(double cosine, double index);

/// By how much the interface of an index whose reflectance along the normal is `f0` throws back
/// more than Schlick's approximation says, at the cosine between light and half vector.
double fresnel_over_schlick(double f0, double cosine);

}  // namespace livery
