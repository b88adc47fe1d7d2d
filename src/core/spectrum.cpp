#include "core/spectrum.h"

#include <algorithm>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/mutation.h"

namespace livery {

namespace {

#include "core/cie_tables.inc"

}  // namespace

Spectrum spectrum_from_samples(std::span<const double> wavelengths_nm,
                               std::span<const double> values) {
    check_argument(!values.empty() && wavelengths_nm.size() == values.size(),
                   "spectrum_from_samples: as many wavelengths as values, at least one");
    check_argument(std::is_sorted(wavelengths_nm.begin(),
                                  wavelengths_nm.end(),
                                  [](double a, double b) { return a <= b; }),
                   "spectrum_from_samples: wavelengths must rise");
    Spectrum spectrum{};
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
        const double nm = kSpectrumFirst_nm + kSpectrumStep_nm * static_cast<double>(k);
        const auto above = std::lower_bound(wavelengths_nm.begin(), wavelengths_nm.end(), nm);
        const auto i = static_cast<std::size_t>(above - wavelengths_nm.begin());
        if (i == 0) {
            spectrum[k] = values.front();
        } else if (i == values.size()) {
            spectrum[k] = values.back();
        } else {
            const double t =
                (nm - wavelengths_nm[i - 1]) / (wavelengths_nm[i] - wavelengths_nm[i - 1]);
            spectrum[k] = (1.0 - t) * values[i - 1] + t * values[i];
        }
    }
    return spectrum;
}

const Spectrum& cie1931_x() { return kCie1931X; }
const Spectrum& cie1931_y() { return kCie1931Y; }
const Spectrum& cie1931_z() { return kCie1931Z; }
const Spectrum& cie1964_x() { return kCie1964X; }
const Spectrum& cie1964_y() { return kCie1964Y; }
const Spectrum& cie1964_z() { return kCie1964Z; }
const Spectrum& illuminant_d65() { return kIlluminantD65; }

glm::dvec3 xyz_from_power(const Spectrum& power) {
    glm::dvec3 xyz(0.0);
    for (std::size_t k = 0; k < power.size(); ++k) {
        xyz += power[k] * glm::dvec3(kCie1931X[k], kCie1931Y[k], kCie1931Z[k]);
    }
    return kSpectrumStep_nm * LIVERY_MUTATED(xyz_from_power, xyz);
}

glm::dvec3 xyz_from_reflectance(const Spectrum& reflectance, const Spectrum& illuminant) {
    Spectrum reflected{};
    for (std::size_t k = 0; k < reflected.size(); ++k) {
        reflected[k] = reflectance[k] * illuminant[k];
    }
    return xyz_from_power(reflected) / xyz_from_power(illuminant).y;
}

namespace {

/// Of XYZ as shares of white's, row by row: least squares over the 217 reflectances of
/// docs/colour.md, each weighted as L*a*b* weights it, with rows that add up to 1.
const glm::dmat3& shares10_from_shares() {
    static const glm::dmat3 matrix = glm::transpose(
        glm::dmat3(0.8958, 0.0918, 0.0124, -0.0228, 0.9639, 0.0589, 0.0267, -0.0407, 1.0140));
    return matrix;
}

}  // namespace

glm::dvec3 d65_xyz10() {
    static const glm::dvec3 white = [] {
        Spectrum one{};
        one.fill(1.0);
        return xyz10_from_reflectance(one);
    }();
    return white;
}

glm::dvec3 xyz10_from_reflectance(const Spectrum& reflectance) {
    glm::dvec3 xyz(0.0);
    double white_y = 0.0;
    for (std::size_t k = 0; k < reflectance.size(); ++k) {
        const double light = illuminant_d65()[k];
        xyz += light * reflectance[k] * glm::dvec3(cie1964_x()[k], cie1964_y()[k], cie1964_z()[k]);
        white_y += light * cie1964_y()[k];
    }
    return xyz / LIVERY_MUTATED(xyz10_white, white_y);
}

glm::dvec3 xyz10_from_xyz(glm::dvec3 xyz) {
    return shares10_from_shares() * (xyz / d65_xyz()) * d65_xyz10();
}

glm::dvec3 xyz_from_xyz10(glm::dvec3 xyz10) {
    static const glm::dmat3 inverse = glm::inverse(shares10_from_shares());
    return inverse * (xyz10 / d65_xyz10()) * d65_xyz();
}

glm::dvec3 lab10_from_xyz10(glm::dvec3 xyz10) { return lab_from_xyz(xyz10, d65_xyz10()); }

glm::dvec3 xyz10_from_lab10(glm::dvec3 lab10) { return xyz_from_lab(lab10, d65_xyz10()); }

}  // namespace livery
