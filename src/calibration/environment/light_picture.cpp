#include "calibration/environment/light_picture.h"

#include <algorithm>
#include <cmath>

namespace livery {

LightPicture light_of(const MergedPhotographs& merged, const glm::dvec3& clipped_light) {
    const ImageF& counts = merged.counts;
    LightPicture picture;
    picture.light = ImageF(counts.width, counts.height, 3);
    picture.saturated = Image8(counts.width, counts.height, 1);
    picture.left_out = Image8(counts.width, counts.height, 1);
    for (std::size_t k = 0; k < counts.pixel_count(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float seconds = merged.seconds.values[3 * k + c];
            if (seconds > 0.0f) {
                picture.light.values[3 * k + c] = counts.values[3 * k + c] / seconds;
            } else {
                picture.light.values[3 * k + c] =
                    static_cast<float>(clipped_light[static_cast<int>(c)]);
                picture.saturated.values[k] = 1;
            }
        }
    }
    return picture;
}

std::optional<SampledLight> sample(const LightPicture& picture,
                                   const glm::dvec2& pixel,
                                   bool wraps) {
    const int width = picture.light.width, height = picture.light.height;
    // Around a panorama the last half pixel's neighbour is the first; above and below nothing is.
    const double x = pixel.x - 0.5;
    const double y = wraps ? std::clamp(pixel.y - 0.5, 0.0, height - 1.0) : pixel.y - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    SampledLight result;
    for (int v = 0; v < 2; ++v) {
        for (int u = 0; u < 2; ++u) {
            const double weight =
                (u == 0 ? 1.0 - (x - x0) : x - x0) * (v == 0 ? 1.0 - (y - y0) : y - y0);
            if (weight <= 0.0) continue;
            int column = static_cast<int>(x0) + u;
            const int row = static_cast<int>(y0) + v;
            if (wraps) column = (column % width + width) % width;
            if (column < 0 || column >= width || row < 0 || row >= height) return std::nullopt;
            if (picture.left_out.at(column, row) != 0) return std::nullopt;
            const float* light = picture.light.pixel(column, row);
            result.light += weight * glm::dvec3(light[0], light[1], light[2]);
            if (picture.saturated.at(column, row) != 0) result.saturated += weight;
        }
    }
    return result;
}

}  // namespace livery
