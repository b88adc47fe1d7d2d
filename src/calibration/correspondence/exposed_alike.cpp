#include "calibration/correspondence/exposed_alike.h"

#include <algorithm>
#include <limits>

#include "calibration/correspondence/fringes.h"
#include "core/error.h"

namespace livery {
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
