// The simulated bench: a spectral projector, a grey mock-up, a room and a camera. It is the world:
// calibration/ and compensation/ meet it only through the three ports.
#pragma once

#include <filesystem>
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
    /// unless the description paints parts of it.
    Bench(const BenchDescription& description,
          std::shared_ptr<const Product> product,
          const Progress& progress = {});
    ~Bench();
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    BenchPorts ports();
    const BenchDescription& description() const;

    /// The observer's truth, never shown to a calibration: spectral XYZ at the eye point of what
    /// each projector pixel lights (3 channels, 0 where it lights nothing of the mock-up).
    ImageF observe_xyz(const Image8& drive) const;

    /// Truth about each projector pixel.
    struct Truth {
        Image8 lit;       ///< 255 where at least half of the pixel lies on lit mock-up
        Image8 edge;      ///< 255 within 2 px of a silhouette, depth or part edge
        ImageF black_xyz; ///< drive 0
        ImageF primary_xyz;  ///< 9 channels: full red, green, blue, each minus black
    };
    const Truth& truth() const;

    /// Whether some drive shows `wanted_xyz` (3 channels, absolute) at each pixel: 255 or 0. Exact
    /// for white-segment projectors too.
    Image8 reachable(const ImageF& wanted_xyz) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
