// The simulated bench: a spectral projector, a grey mock-up, a room and a camera. It is the world:
// calibration/ and compensation/ meet it only through the three ports.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/bench_ports.h"
#include "core/image.h"
#include "core/progress.h"
#include "scene/product.h"
#include "scene/view.h"
#include "twin/description.h"
#include "twin/light_transport.h"
#include "twin/received.h"

namespace livery {

bool has_room_light(const std::vector<MishapDescription>& mishaps);

/// The light on the camera's pixels at this photograph. `room_light`: a room light of 1 on them;
/// empty where there is none.
ImageF with_mishaps(ImageF units_per_s,
                    const ImageF& room_light,
                    const std::vector<MishapDescription>& mishaps,
                    std::uint32_t photograph);

/// How long the camera exposes when it says `exposure_s`.
double true_exposure_s(double exposure_s,
                       const CameraDescription& camera,
                       const ImageF& units_per_s,
                       const std::vector<MishapDescription>& mishaps,
                       std::uint32_t photograph);

/// The observer's picture: each pixel what the eye sees in one direction, whichever projector
/// pixels light it. What the audience sees is judged here: light that falls on another place of
/// the mock-up than was meant is wrong here, though it is right in the projector's pixels.
struct BenchEye {
    View view;  ///< in the mock-up's frame
    Observer observer;
};

class Bench {
  public:
    /// Traces what each camera and projector pixel sees. `product` is the mock-up, grey all over
    /// unless the description paints parts of it. Throws std::invalid_argument (no picture, no
    /// reflectance for a part, a description that names a part there is not).
    Bench(const BenchDescription& description,
          std::shared_ptr<const Product> product,
          const Progress& progress = {},
          EyePicture eye_picture = EyePicture::none);
    /// The same on light that was traced before. Throws std::invalid_argument also where that was
    /// of another geometry (key_of_transport()).
    Bench(const BenchDescription& description,
          std::shared_ptr<const Product> product,
          std::shared_ptr<const LightTransport> light);
    ~Bench();
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    /// Valid as long as the bench; for one thread at a time. Each photograph differs in its noise;
    /// the same calls in the same order give the same photographs.
    BenchPorts ports();
    const BenchDescription& description() const;

    /// The exposure that photographs have until one asks for another.
    double default_exposure_s() const;

    /// The observer's truth, never shown to a calibration: spectral XYZ toward the eye point of
    /// what each projector pixel lights (3 channels, 0 where it lights nothing): the mean over the
    /// lit part of the pixel, under the lamp's nominal light. A white diffuser that
    /// faces the projector's full red + green + blue at the distance of the mock-up's middle has Y
    /// = 1.
    ImageF observe_xyz(const Image8& drive) const;

    /// Truth about each projector pixel.
    const ObserverTruth& truth() const;

    /// Whether some drive shows `wanted_xyz` (3 channels, absolute) at each pixel, to 1e-4 of full
    /// drive: 255 or 0. Exact for white-segment projectors too. Counts the light of the pixel
    /// itself and of black, not what other parts throw on it.
    Image8 reachable(const ImageF& wanted_xyz) const;

    /// The same in the eye's picture. Throw std::invalid_argument where it was not traced.
    const BenchEye& eye() const;
    ImageF observe_from_eye(const Image8& drive) const;
    Image8 reachable_from_eye(const ImageF& wanted_xyz) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
