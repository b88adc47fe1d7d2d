#include "jobs/render/target_picture.h"

#include "core/channels.h"
#include "core/colour.h"
#include "core/error.h"
#include "core/image_io.h"

namespace livery {

TargetPicture read_target_picture(const std::filesystem::path& file, int width, int height) {
    const ImageFile picture = read_image(file);
    if (!picture.floating_point) {
        throw FileError(file, "pixels", "integers", "linear floating point (.exr)");
    }
    if (picture.image.width != width || picture.image.height != height) {
        throw FileError(
            file,
            "size",
            std::to_string(picture.image.width) + "x" + std::to_string(picture.image.height),
            "the calibrated projector's " + std::to_string(width) + "x" + std::to_string(height));
    }
    const std::array<int, 3> colour = colour_channels(file, picture);
    const int alpha = channel_named(picture, "A");
    ImageF wanted(width, height, 4, 1.0f);
    const auto channels = static_cast<std::size_t>(picture.image.channels);
    for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
        const float* v = picture.image.values.data() + channels * i;
        glm::dvec3 rgb =
            working_from_rec709() * glm::dvec3(v[colour[0]], v[colour[1]], v[colour[2]]);
        float* out = wanted.values.data() + 4 * i;
        if (alpha >= 0) {
            out[3] = v[alpha];
            // The colour of what covers the pixel; nothing does where A is 0
            if (v[alpha] > 0.0f) rgb /= static_cast<double>(v[alpha]);
        }
        for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(rgb[c]);
    }
    return {std::move(wanted), alpha >= 0};
}

}  // namespace livery
