// The spectral integrals of a bench, done once: light channel x reflectance x sensor.
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "twin/description.h"
#include "twin/light_paths.h"

namespace livery {

/// Light channels: red, green, blue, clear.
inline constexpr int kLightChannels = 4;

/// Spectral power of each light channel at 1, scaled so that full red + green + blue has luminance
/// 1 on a white diffuser, and the clear segment too.
std::array<Spectrum, kLightChannels> scaled_lights(const ProjectorSpectra& spectra);

/// The room's light as a white diffuser reflects it.
Spectrum scaled_ambient(const BenchDescription& bench);

/// The three curves of a sensor: what it reads is the sum over bands of power times curve.
using Sensor = std::array<Spectrum, 3>;
Sensor observer_sensor();                             ///< reads XYZ
Sensor camera_sensor(const BenchDescription& bench);  ///< reads file units a second

/// Linear light makes the sum over wavelengths a constant for each combination that occurs.
struct Factors {
    using PerChannel = std::array<glm::dvec3, kLightChannels>;
    std::vector<PerChannel> direct;               ///< [surface]
    std::vector<glm::dvec3> ambient;              ///< [surface]
    std::vector<std::vector<PerChannel>> bounce;  ///< [surface seen][surface that lights it]
};
Factors fold(const BenchDescription& bench, const SurfaceSet& surfaces, const Sensor& sensor);

}  // namespace livery
