#include "ledger/accuracy/chain_spectra.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/colour.h"
#include "core/hash.h"
#include "core/paths.h"
#include "ledger/accuracy/chain_steps.h"
#include "twin/painted_sphere.h"

namespace livery {

namespace {

constexpr const char* kDirect = "three channels, one paint";
constexpr const char* kMutual = "three channels, light from paint to paint";

/// CIE 15: Planck's law at 2848 K with c2 = 1.435e-2 m K, 100 at 560 nm.
Spectrum illuminant_a() {
    Spectrum power{};
    const auto planck = [](double nm) { return std::exp(1.435e7 / (2848.0 * nm)) - 1.0; };
    for (std::size_t k = 0; k < power.size(); ++k) {
        const double nm = kSpectrumFirst_nm + kSpectrumStep_nm * static_cast<double>(k);
        power[k] = 100.0 * std::pow(560.0 / nm, 5.0) * planck(560.0) / planck(nm);
    }
    return power;
}

std::string hash_of_spectra() {
    Hasher hasher;
    for (const auto& spectra : {known_reflectances(), known_lights()}) {
        for (const NamedSpectrum& one : spectra) {
            hasher.add(one.name);
            hasher.add(std::span<const double>(one.values));
        }
    }
    return hasher.hex();
}

void measure(std::vector<ChainRow>& rows, const Progress& progress) {
    const std::vector<NamedSpectrum> paints = known_reflectances();
    for (const NamedSpectrum& light : known_lights()) {
        progress.check_stop();
        std::vector<float> direct, mutual;
        for (std::size_t a = 0; a < paints.size(); ++a) {
            direct.push_back(static_cast<float>(
                three_channel_error(std::array<Spectrum, 1>{paints[a].values}, light.values)));
            // A product of spectra is the same in any order
            for (std::size_t b = a; b < paints.size(); ++b) {
                const std::array both{paints[a].values, paints[b].values};
                mutual.push_back(static_cast<float>(three_channel_error(both, light.values)));
            }
        }
        for (ChainRow& row : rows) {
            if (row.level == light.name) set_errors(row, row.what == kDirect ? direct : mutual);
        }
    }
}

}  // namespace

std::vector<NamedSpectrum> known_reflectances() {
    std::vector<NamedSpectrum> known;
    const SpectrumTable chart =
        read_spectra_csv(shipped_path("calibration/spectra/colorchecker.csv"));
    for (std::size_t k = 0; k < chart.names.size(); ++k) {
        known.push_back({chart.names[k], chart.columns[k]});
    }
    for (const std::string& name : spectral_paint_names()) {
        const SpectralPaint paint = read_spectral_paint(name);
        known.push_back({paint.name, paint.family == "metallic" ? paint.f0 : paint.diffuse});
    }
    return known;
}

std::vector<NamedSpectrum> known_lights() {
    const ProjectorSpectra projector = uhp_projector();
    NamedSpectrum mercury{"mercury projector", {}};
    for (const Spectrum& primary : projector.primaries) {
        for (std::size_t k = 0; k < primary.size(); ++k) mercury.values[k] += primary[k];
    }
    return {{"D65", illuminant_d65()},
            {"illuminant A", illuminant_a()},
            {"white LED", white_led()},
            mercury};
}

double three_channel_error(std::span<const Spectrum> reflectances, const Spectrum& light) {
    const double light_y = xyz_from_power(light).y;
    Spectrum reflected = light;
    glm::dvec3 rgb_working = working_from_xyz() * xyz_from_power(light) / light_y;
    for (const Spectrum& reflectance : reflectances) {
        for (std::size_t k = 0; k < reflected.size(); ++k) reflected[k] *= reflectance[k];
        rgb_working *= working_from_xyz() * xyz_from_reflectance(reflectance, illuminant_d65());
    }
    return ciede2000(lab_from_xyz(xyz_from_working() * rgb_working, d65_xyz()),
                     lab_from_xyz(xyz_from_power(reflected) / light_y, d65_xyz()));
}

std::vector<ChainPart> spectral_parts(const AccuracyOptions&) {
    ChainPart part;
    for (const char* what : {kDirect, kMutual}) {
        for (const NamedSpectrum& light : known_lights()) {
            part.rows.push_back({what, light.name, "the integral over the spectrum"});
        }
    }
    part.inputs = hash_of_spectra;
    part.measure = measure;
    return {part};
}

}  // namespace livery
