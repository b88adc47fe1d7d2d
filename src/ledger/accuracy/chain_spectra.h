// What three channels make of light and paint that have spectra.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/spectrum.h"

namespace livery {

struct NamedSpectrum {
    std::string name;
    Spectrum values{};
};

/// Reflectances: the 24 patches of the shipped ColorChecker, and of each shipped paint its diffuse
/// layer, or its metal where it has that. Throws FileError.
std::vector<NamedSpectrum> known_reflectances();

/// Lights: D65, CIE illuminant A, the twin's white LED, the white of its mercury projector.
std::vector<NamedSpectrum> known_lights();

/// CIEDE2000 between light that has met reflectances one after the other as the renderer has it
/// (each as the working space's RGB under D65, multiplied) and as the integral over the spectrum
/// has it; CIE 1931 as everywhere in the program, D65 white of the light's luminance.
double three_channel_error(std::span<const Spectrum> reflectances, const Spectrum& light);

}  // namespace livery
