// Simulated benches that share the tracing of their light, which takes as long as a calibration.
#pragma once

#include <list>
#include <memory>

#include "twin/bench.h"

namespace livery::testing {

/// Traced when first asked for; the last few are kept.
inline std::shared_ptr<const LightTransport> kept_light(const BenchDescription& description,
                                                        const Product& product,
                                                        EyePicture eye_picture) {
    constexpr std::size_t kMost = 6;
    static std::list<std::shared_ptr<const LightTransport>> kept;
    const std::string key = key_of_transport(description, product, eye_picture);
    for (const auto& light : kept)
        if (light->made_of == key) return light;
    if (kept.size() == kMost) kept.pop_back();
    kept.push_front(trace_light(description, product, eye_picture, {}));
    return kept.front();
}

/// As Bench(description, product).
inline Bench bench_on_kept_light(const BenchDescription& description,
                                 std::shared_ptr<const Product> product,
                                 EyePicture eye_picture = EyePicture::none) {
    auto light = kept_light(description, *product, eye_picture);
    return Bench(description, std::move(product), std::move(light));
}

}  // namespace livery::testing
