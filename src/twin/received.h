// The sparse sum that makes a picture: light of the projector's pixels over traced paths, by
// spectral integrals that are done once.
#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"
#include "scene/view.h"
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

/// Truth about each pixel of an observer, never shown to a calibration.
struct ObserverTruth {
    Image8 lit;          ///< 255 where at least half of the pixel lies on lit mock-up
    Image8 edge;         ///< 255 within 2 px of a silhouette, depth or part edge
    Image8 seen_by_eye;  ///< 255 where the eye sees at least half of the mock-up in the pixel
    ImageF black_xyz;    ///< drive 0 everywhere
    /// 9 channels: full red, green, blue, each minus black, in wide surroundings of the same
    /// drive; without the light that other parts throw on this one.
    ImageF primary_xyz;
};

struct Observer {
    Receivers receivers;
    ObserverTruth truth;
    ImageF clear_xyz;  ///< the clear segment at 1, as primary_xyz
};

/// From the paths on, which outlive it. `dark` is the projector's light at drive 0.
Observer make_observer(const TracedObserver& traced,
                       Factors factors,
                       const Gathers& gathers,
                       const ImageF& dark);

/// XYZ of each pixel under the projector's light, the room's included.
ImageF observe(const Observer& observer, const Gathers& gathers, const ImageF& light, bool ambient);

/// As Bench::reachable(); `clear_strength` is the luminance of the clear segment.
Image8 reachable(const Observer& observer, const ImageF& wanted_xyz, double clear_strength);

/// 255 where at least half of what a pixel gets comes from the projector pixels of `mask` (255).
Image8 mostly_lit_by(const Observer& observer, const Image8& mask);

/// The eye's picture of a mock-up: aimed at its middle, as large as the mock-up needs, and in the
/// middle as fine as the projector's.
View eye_view(const glm::dvec3& eye_mm, const View& projector, const Mesh& mockup);

}  // namespace livery
