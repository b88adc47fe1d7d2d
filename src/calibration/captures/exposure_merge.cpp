#include "calibration/captures/exposure_merge.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/mutation.h"

namespace livery {

namespace {

/// Sensors bend shortly before they clip.
constexpr double kLinearShare = 0.95;

float largest_linear(const Photograph& photograph) {
    return static_cast<float>(photograph.black_level +
                              kLinearShare * (photograph.saturates_at - photograph.black_level));
}

}  // namespace

Photograph windowed(const Photograph& photograph, const PictureWindow& window) {
    const ImageF& image = photograph.image;
    const int block = window.block;
    check_argument(block > 0 && window.left >= 0 && window.top >= 0 && window.width > 0 &&
                       window.height > 0 && window.left + block * window.width <= image.width &&
                       window.top + block * window.height <= image.height,
                   fmt::format("windowed: {}x{} blocks of {} at {},{} in {}x{} pixels",
                               window.width,
                               window.height,
                               block,
                               window.left,
                               window.top,
                               image.width,
                               image.height));
    Photograph result = photograph;
    result.image = ImageF(window.width, window.height, 3);
    const float limit = largest_linear(photograph);
    for (int y = 0; y < window.height; ++y) {
        for (int x = 0; x < window.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                double sum = 0.0;
                bool saturated = false;
                for (int v = 0; v < block; ++v) {
                    for (int u = 0; u < block; ++u) {
                        const float value =
                            image.at(window.left + x * block + u, window.top + y * block + v, c);
                        saturated = saturated || value >= limit;
                        sum += static_cast<double>(value);
                    }
                }
                result.image.at(x, y, c) = saturated ? static_cast<float>(photograph.saturates_at)
                                                     : static_cast<float>(sum / (block * block));
            }
        }
    }
    return result;
}

double clipped_light(const Photograph& photograph) {
    return (static_cast<double>(largest_linear(photograph)) - photograph.black_level) /
           photograph.exposure_s;
}

void add(const Photograph& photograph, MergedPhotographs& merged) {
    const ImageF& image = photograph.image;
    check_argument(image.channels == 3 && photograph.exposure_s > 0.0,
                   "exposure_merge: three channels and an exposure above 0");
    if (merged.counts.empty()) {
        merged.counts = ImageF(image.width, image.height, 3);
        merged.seconds = ImageF(image.width, image.height, 3);
    }
    check_argument(image.width == merged.counts.width && image.height == merged.counts.height,
                   fmt::format("exposure_merge: {}x{} pixels after {}x{}",
                               image.width,
                               image.height,
                               merged.counts.width,
                               merged.counts.height));
    const float limit = largest_linear(photograph);
    const auto black = static_cast<float>(photograph.black_level);
    const auto seconds = static_cast<float>(photograph.exposure_s);
    for (std::size_t k = 0; k < image.values.size(); ++k) {
        if (image.values[k] >= limit) continue;
        merged.counts.values[k] += image.values[k] - LIVERY_MUTATED(exposure_black, black);
        merged.seconds.values[k] += seconds;
    }
}

}  // namespace livery
