// Spectra from 380 to 780 nm in 5 nm steps, and what the CIE's observers make of them.
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

/// CIE 1964 10 degree observer, by whom paint is measured (ten_degree.h).
const Spectrum& cie1964_x();
const Spectrum& cie1964_y();
const Spectrum& cie1964_z();

/// CIE D65, relative, 100 at 560 nm.
const Spectrum& illuminant_d65();

/// XYZ of a spectral power, as the plain sum over bands times the step (no 683 lm/W).
glm::dvec3 xyz_from_power(const Spectrum& power);

/// XYZ of a reflectance under an illuminant, scaled so that a perfect white has Y = 1.
glm::dvec3 xyz_from_reflectance(const Spectrum& reflectance, const Spectrum& illuminant);

}  // namespace livery
