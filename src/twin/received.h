// The sparse sum that makes a picture: light of the projector's pixels over traced paths, by
// spectral integrals that are done once.
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "twin/description.h"
#include "twin/light_paths.h"
#include "twin/light_transport.h"

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

/// Everything fixed about one kind of receiver.
struct Receivers {
    const TracedReceivers* traced = nullptr;  ///< outlives this
    Factors factors;
};

/// What each gather place throws on: [place * surfaces + surface seen], in the sensor's units.
std::vector<glm::vec3> bounced_light(const Gathers& gathers,
                                     const Factors& factors,
                                     const ImageF& light);

/// Reading of receiver i, ambient light apart.
glm::vec3 receive(const Receivers& receivers,
                  const std::vector<glm::vec3>& bounced,
                  const ImageF& light,
                  std::size_t i);

/// All of them as a picture (3 channels); 0 where nothing of the mock-up is.
ImageF receive_all(const Receivers& receivers, const Gathers& gathers, const ImageF& light);

/// Reading of receiver i in the room's light alone, and the picture of it.
glm::vec3 receive_ambient(const Receivers& receivers, std::size_t i);
ImageF receive_ambient(const Receivers& receivers);

}  // namespace livery
