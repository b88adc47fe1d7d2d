// The simulated bench: a spectral projector, a grey mock-up, a room and a camera. It is the world:
// calibration/ and compensation/ meet it only through the three ports.
#pragma once

#include <memory>

#include "core/bench_ports.h"
#include "core/image.h"
#include "core/progress.h"
#include "scene/product.h"
#include "scene/view.h"
#include "twin/description.h"

namespace livery {

class Bench {
  public:
    /// Traces what each camera and projector pixel sees. `product` is the mock-up, grey all over
    /// unless the description paints parts of it. Throws std::invalid_argument (no picture, no
    /// reflectance for a part, a description that names a part there is not).
    Bench(const BenchDescription& description,
          std::shared_ptr<const Product> product,
          const Progress& progress = {});
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
    struct Truth {
        Image8 lit;          ///< 255 where at least half of the pixel lies on lit mock-up
        Image8 edge;         ///< 255 within 2 px of a silhouette, depth or part edge
        Image8 seen_by_eye;  ///< 255 where the eye sees at least half of what the pixel lights
        ImageF black_xyz;    ///< drive 0 everywhere
        /// 9 channels: full red, green, blue, each minus black, in wide surroundings of the same
        /// drive; without the light that other parts throw on this one.
        ImageF primary_xyz;
    };
    const Truth& truth() const;

    /// Whether some drive shows `wanted_xyz` (3 channels, absolute) at each pixel, to 1e-4 of full
    /// drive: 255 or 0. Exact for white-segment projectors too. Counts the light of the pixel
    /// itself and of black, not what other parts throw on it.
    Image8 reachable(const ImageF& wanted_xyz) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
