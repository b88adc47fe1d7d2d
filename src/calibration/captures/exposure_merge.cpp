#include "calibration/captures/exposure_merge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "calibration/correspondence/patterns.h"
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

namespace {

std::string size_of(const ImageF& image) {
    return std::to_string(image.width) + "x" + std::to_string(image.height);
}

/// Mean of the channels, in file units as if exposed like `like`.
ImageF mean_exposed_as(const Photograph& photograph, bool fringe, const Photograph& like) {
    ImageF mean = fringe ? unsaturated_mean(photograph) : mean_of_channels(photograph.image);
    const auto gain = static_cast<float>(like.exposure_s / photograph.exposure_s);
    const auto black = static_cast<float>(photograph.black_level);
    const auto offset = static_cast<float>(like.black_level);
    for (float& value : mean.values) value = (value - black) * gain + offset;
    return mean;
}

}  // namespace

ImageF mean_of_channels(const ImageF& image) {
    if (image.channels == 1) return image;
    ImageF mean(image.width, image.height, 1);
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t used = std::min<std::size_t>(channels, 3);  // a fourth one is no light
    for (std::size_t i = 0; i < mean.values.size(); ++i) {
        float sum = 0.0f;
        for (std::size_t c = 0; c < used; ++c) sum += image.values[i * channels + c];
        mean.values[i] = sum / static_cast<float>(used);
    }
    return mean;
}

ImageF unsaturated_mean(const Photograph& photograph) {
    constexpr double kFull = 0.98;
    const ImageF& image = photograph.image;
    ImageF mean = mean_of_channels(image);
    const auto limit = static_cast<float>(
        photograph.black_level + kFull * (photograph.saturates_at - photograph.black_level));
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t used = std::min<std::size_t>(channels, 3);
    for (std::size_t i = 0; i < mean.values.size(); ++i)
        for (std::size_t c = 0; c < used; ++c)
            if (image.values[i * channels + c] >= limit)
                mean.values[i] = std::numeric_limits<float>::quiet_NaN();
    return mean;
}

ImageF exposed_alike(const std::vector<RoledPhotograph>& photographs,
                     const std::string& role,
                     const RoledPhotograph& like) {
    ImageF mean;
    std::size_t found = 0;
    for (const RoledPhotograph& one : photographs) {
        if (one.role != role) continue;
        const ImageF& image = one.photograph.image;
        if (image.empty() || image.width != like.photograph.image.width ||
            image.height != like.photograph.image.height)
            throw FileError(one.photograph.name.empty() ? role : one.photograph.name,
                            "size",
                            size_of(image),
                            size_of(like.photograph.image) + " as " + like.role);
        const ImageF next = mean_exposed_as(one.photograph, is_fringe_role(role), like.photograph);
        if (++found == 1) {
            mean = next;
            continue;
        }
        const auto share = static_cast<float>(1.0 / static_cast<double>(found));
        for (std::size_t i = 0; i < mean.values.size(); ++i)
            mean.values[i] += share * (next.values[i] - mean.values[i]);
    }
    check_argument(found > 0, "no photograph of " + role);
    return mean;
}

}  // namespace livery
