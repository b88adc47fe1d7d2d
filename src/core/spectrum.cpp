#include "core/spectrum.h"

#include <algorithm>

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

}  // namespace livery
