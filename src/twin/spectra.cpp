#include "twin/spectra.h"

#include <cmath>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "core/paths.h"
#include "core/text/csv.h"

namespace livery {

namespace {

constexpr std::size_t kMaxColumns = 64;
constexpr std::size_t kMaxRows = 10'000;

double wavelength_nm(std::size_t band) {
    return kSpectrumFirst_nm + kSpectrumStep_nm * static_cast<double>(band);
}

double gaussian(double nm, double centre_nm, double sigma_nm) {
    const double z = (nm - centre_nm) / sigma_nm;
    return std::exp(-0.5 * z * z);
}

/// A dichroic's pass band: 1 between the edges, `slope_nm` wide shoulders.
double pass_band(double nm, double low_nm, double high_nm, double slope_nm) {
    return 1.0 / ((1.0 + std::exp((low_nm - nm) / slope_nm)) *
                  (1.0 + std::exp((nm - high_nm) / slope_nm)));
}

/// Scales the primaries so that together they have a white point: the share of time or light that a
/// maker gives to each channel.
void balance(std::array<Spectrum, 3>& primaries, double white_x, double white_y) {
    glm::dmat3 xyz_from_primary;
    for (int k = 0; k < 3; ++k) {
        xyz_from_primary[k] = xyz_from_power(primaries[static_cast<std::size_t>(k)]);
    }
    const glm::dvec3 white(white_x / white_y, 1.0, (1.0 - white_x - white_y) / white_y);
    const glm::dvec3 share = glm::inverse(xyz_from_primary) * white;
    for (int k = 0; k < 3; ++k) {
        for (double& value : primaries[static_cast<std::size_t>(k)]) value *= share[k];
    }
}

}  // namespace

SpectrumTable read_spectra_csv(const std::filesystem::path& file) {
    return parse_spectra_csv(read_text_file(file, 4u << 20u), file);
}

SpectrumTable parse_spectra_csv(const std::string& text, const std::filesystem::path& file) {
    CsvReader csv(text, file, kMaxColumns + 1);
    const auto& names = csv.names();
    if (names.front() != "wavelength" && names.front() != "nm") {
        throw FileError(file,
                        csv.place(),
                        "a first column '" + names.front().substr(0, 40) + "'",
                        "'wavelength' or 'nm'");
    }
    if (names.size() < 2) throw FileError(file, csv.place(), "no spectrum", "one or more");
    SpectrumTable table;
    table.names.assign(names.begin() + 1, names.end());
    std::vector<double> wavelengths;
    std::vector<std::vector<double>> columns(table.names.size());
    while (csv.next()) {
        for (std::size_t c = 0; c < names.size(); ++c) {
            const double value = csv.number(c);
            if (value < 0.0) csv.fail(c, "a finite number, 0 or more");
            (c == 0 ? wavelengths : columns[c - 1]).push_back(value);
        }
        if (wavelengths.size() > 1 && !(wavelengths.back() > wavelengths[wavelengths.size() - 2])) {
            csv.fail(0, "a wavelength above that of the row before");
        }
        if (wavelengths.size() > kMaxRows) {
            throw FileError(file, csv.place(), "more rows", "at most " + std::to_string(kMaxRows));
        }
    }
    if (wavelengths.size() < 2) {
        throw FileError(file, "", std::to_string(wavelengths.size()) + " rows", "2 or more");
    }
    if (wavelengths.front() > 400.0 || wavelengths.back() < 700.0) {
        throw FileError(file,
                        "wavelength",
                        std::to_string(wavelengths.front()) + " to " +
                            std::to_string(wavelengths.back()) + " nm",
                        "400 to 700 nm at least");
    }
    for (const auto& column : columns) {
        table.columns.push_back(spectrum_from_samples(wavelengths, column));
    }
    return table;
}

ProjectorSpectra uhp_projector() {
    ProjectorSpectra spectra;
    for (std::size_t k = 0; k < spectra.clear.size(); ++k) {
        const double nm = wavelength_nm(k);
        // Mercury at some 200 bar: the lines broaden by nanometres, and a continuum that grows to
        // the red joins them.
        const double lamp = 0.22 + 0.06 * (nm - 380.0) / 400.0 + 0.70 * gaussian(nm, 404.7, 3.5) +
                            1.00 * gaussian(nm, 435.8, 4.5) + 0.90 * gaussian(nm, 546.1, 5.0) +
                            0.75 * gaussian(nm, 578.0, 5.5);
        spectra.primaries[0][k] = lamp * pass_band(nm, 592.0, 705.0, 3.5);
        spectra.primaries[1][k] = lamp * pass_band(nm, 505.0, 573.0, 4.0);
        spectra.primaries[2][k] = lamp * pass_band(nm, 420.0, 492.0, 4.0);
        spectra.clear[k] = lamp * pass_band(nm, 418.0, 705.0, 4.0);
    }
    balance(spectra.primaries, 0.3050, 0.3250);
    return spectra;
}

ProjectorSpectra led_projector() {
    ProjectorSpectra spectra;
    for (std::size_t k = 0; k < spectra.clear.size(); ++k) {
        const double nm = wavelength_nm(k);
        spectra.primaries[0][k] = gaussian(nm, 628.0, 8.5);
        spectra.primaries[1][k] = gaussian(nm, 523.0, 15.0);
        spectra.primaries[2][k] = gaussian(nm, 458.0, 9.5);
    }
    balance(spectra.primaries, 0.3127, 0.3290);
    for (std::size_t k = 0; k < spectra.clear.size(); ++k) {
        spectra.clear[k] =
            spectra.primaries[0][k] + spectra.primaries[1][k] + spectra.primaries[2][k];
    }
    return spectra;
}

Spectrum grey_spray_paint() {
    Spectrum reflectance{};
    for (std::size_t k = 0; k < reflectance.size(); ++k) {
        const double nm = wavelength_nm(k);
        reflectance[k] =
            (0.55 + 0.02 * (nm - 550.0) / 150.0) / (1.0 + 0.5 * std::exp((395.0 - nm) / 12.0));
    }
    return reflectance;
}

Spectrum white_led() {
    Spectrum power{};
    for (std::size_t k = 0; k < power.size(); ++k) {
        const double nm = wavelength_nm(k);
        power[k] = 0.85 * gaussian(nm, 452.0, 9.5) + gaussian(nm, 560.0, 55.0) +
                   0.35 * gaussian(nm, 625.0, 40.0);
    }
    return power;
}

}  // namespace livery
