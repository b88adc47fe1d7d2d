// Where a bench's light goes: from the projector's pixels over the mock-up to camera, projector and
// eye. It is the geometry alone. Spectra, the projector's response, the room's light, the sensor,
// its noise and mishaps come after it, so that benches that differ in those share it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/progress.h"
#include "scene/product.h"
#include "twin/interreflection.h"
#include "twin/light_paths.h"

namespace livery {

/// Whether the observer's own picture is traced besides what each projector pixel lights.
enum class EyePicture { none, traced };

/// What the pixels of one picture get. Without interreflection `blends` is empty.
struct TracedReceivers {
    int width = 0, height = 0;
    LightPaths paths;
    std::vector<Gathers::Blend> blends;
};

struct TracedObserver {
    TracedReceivers receivers;
    Image8 lit, edge, seen_by_eye;  ///< as ObservedPaths
};

struct LightTransport {
    std::string made_of;  ///< key_of_transport()
    TracedReceivers camera;
    TracedObserver projector;  ///< what each projector pixel lights, seen from the eye
    std::optional<View> eye_view;
    std::optional<TracedObserver> eye;
    Gathers gathers;
};

/// Hash of all that light transport depends on: views, vignetting, samples, the mock-up with what
/// stands around it, and which place has which reflectance, whatever its spectrum.
std::string key_of_transport(const BenchDescription& description,
                             const Product& product,
                             EyePicture eye_picture);

/// Throws std::invalid_argument as Bench.
std::shared_ptr<const LightTransport> trace_light(const BenchDescription& description,
                                                  const Product& product,
                                                  EyePicture eye_picture,
                                                  const Progress& progress);

}  // namespace livery
