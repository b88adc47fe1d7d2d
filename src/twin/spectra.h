// The spectra of a bench: tables read from CSV, and light sources synthesised here.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/spectrum.h"

namespace livery {

/// Columns of a spectral table, resampled to our bands.
struct SpectrumTable {
    std::vector<std::string> names;
    std::vector<Spectrum> columns;
};

/// Reads a CSV whose header is `wavelength` (or `nm`) and column names, then one row a wavelength
/// in nanometres, rising, from 400 nm or below to 700 nm or above; values finite and not negative.
/// Lines that start with # are comments. Throws FileError.
SpectrumTable read_spectra_csv(const std::filesystem::path& file);
/// The same of its text.
SpectrumTable parse_spectra_csv(const std::string& text, const std::filesystem::path& file);

/// The light of a projector's channels at full drive, relative power.
struct ProjectorSpectra {
    std::array<Spectrum, 3> primaries{};  ///< red, green, blue
    Spectrum clear{};                     ///< the clear segment of a colour wheel
};

/// Synthesised, not measured: a high-pressure mercury lamp (broadened lines on a continuum) through
/// dichroic red, green and blue segments; the clear segment is the lamp behind its ultraviolet
/// filter.
ProjectorSpectra uhp_projector();

/// Synthesised, not measured: three Gaussian LEDs; the clear segment is all three lit at once.
ProjectorSpectra led_projector();

/// Synthesised, not measured: the nearly neutral 55% grey of a spray can, slightly warm, darker in
/// the violet where the pigment absorbs.
Spectrum grey_spray_paint();

/// Synthesised, not measured: a room's white LED, a blue pump and a broad phosphor.
Spectrum white_led();

}  // namespace livery
