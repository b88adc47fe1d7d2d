#include "mesh/part_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/channels.h"
#include "core/error.h"

namespace livery {

ArtworkPicture artwork_picture_of(const ImageFile& from, const std::filesystem::path& file) {
    const ImageF& image = from.image;
    const std::array<int, 3> colour = colour_channels(file, from);
    const int alpha = channel_named(from, "A");
    ArtworkPicture picture;
    picture.file = file;
    picture.linear = from.floating_point;
    picture.has_alpha = alpha >= 0;
    picture.rgba = ImageF(image.width, image.height, 4);
    const auto scale = static_cast<float>(1.0 / from.full_scale);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const float* values = &image.values[i * static_cast<std::size_t>(image.channels)];
        for (int c = 0; c < image.channels; ++c) {
            if (std::isfinite(values[c])) continue;
            throw FileError(file, "pixels", "a value that is not finite", "finite numbers");
        }
        float* rgba = &picture.rgba.values[4 * i];
        for (std::size_t c = 0; c < 3; ++c) {
            rgba[c] = std::clamp(scale * values[colour[c]], 0.0f, 1.0f);
        }
        rgba[3] = alpha >= 0 ? std::clamp(scale * values[alpha], 0.0f, 1.0f) : 1.0f;
    }
    return picture;
}

}  // namespace livery
