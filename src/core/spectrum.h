// Spectra from 380 to 780 nm in 5 nm steps, what the CIE's observers make of them, and the colours
// that paint instruments give: D65 and the CIE 1964 observer, whose field is 10 degrees.
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

namespace livery {

inline constexpr int kSpectrumCount = 81;
inline constexpr double kSpectrumFirst_nm = 380.0;
inline constexpr double kSpectrumStep_nm = 5.0;

/// Value k stands for the band around 380 + 5 k nm.
using Spectrum = std::array<double, kSpectrumCount>;

/// Linear interpolation of tabulated values onto our bands; the end values are held outside.
/// Throws std::invalid_argument when wavelengths do not rise or the lengths differ.
Spectrum spectrum_from_samples(std::span<const double> wavelengths_nm,
                               std::span<const double> values);

/// CIE 1931 2 degree observer at our bands.
const Spectrum& cie1931_x();
const Spectrum& cie1931_y();
const Spectrum& cie1931_z();

/// CIE 1964 10 degree observer, by whom paint is measured.
const Spectrum& cie1964_x();
const Spectrum& cie1964_y();
const Spectrum& cie1964_z();

/// CIE D65, relative, 100 at 560 nm.
const Spectrum& illuminant_d65();

/// XYZ of a spectral power, as the plain sum over bands times the step (no 683 lm/W).
glm::dvec3 xyz_from_power(const Spectrum& power);

/// XYZ of a reflectance under an illuminant, scaled so that a perfect white has Y = 1.
glm::dvec3 xyz_from_reflectance(const Spectrum& reflectance, const Spectrum& illuminant);

/// XYZ of D65 for the 10 degree observer, with Y = 1.
glm::dvec3 d65_xyz10();

/// Of a reflectance under D65, exactly.
glm::dvec3 xyz10_from_reflectance(const Spectrum& reflectance);

/// The likely colour for the one observer of a surface known only by what the other sees under D65.
/// Linear, white stays white; surfaces that look alike to one need not to the other
/// (docs/colour.md says how far that goes).
glm::dvec3 xyz10_from_xyz(glm::dvec3 xyz);
glm::dvec3 xyz_from_xyz10(glm::dvec3 xyz10);

/// L*a*b* with D65 as white.
glm::dvec3 lab10_from_xyz10(glm::dvec3 xyz10);
glm::dvec3 xyz10_from_lab10(glm::dvec3 lab10);

}  // namespace livery
