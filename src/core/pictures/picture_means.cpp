#include "core/pictures/picture_means.h"

#include <cmath>
#include <limits>

#include "core/colour.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/worst_error.h"

namespace livery {

ImageF colour_difference_map(const ImageF& drawn, const ImageF& truth) {
    check_argument(drawn.width == truth.width && drawn.height == truth.height &&
                       drawn.channels == 4 && truth.channels == 4,
                   "colour_differences: two pictures of one size with coverage are needed");
    constexpr float kHalf = 0.5f;
    const glm::dmat3 to_xyz = xyz_from_working();
    const glm::dvec3 white = to_xyz * glm::dvec3(1.0);
    ImageF map(truth.width, truth.height, 1, std::numeric_limits<float>::quiet_NaN());
    parallel_for(map.values.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* a = drawn.values.data() + 4 * i;
            const float* b = truth.values.data() + 4 * i;
            if (a[3] < kHalf || b[3] < kHalf) continue;
            const auto lab = [&](const float* v) {
                return lab_from_xyz(to_xyz * glm::dvec3(v[0], v[1], v[2]), white);
            };
            map.values[i] = worst_if_nan(static_cast<float>(ciede2000(lab(a), lab(b))));
        }
    });
    return map;
}

std::vector<float> covered_differences(const ImageF& map) {
    std::vector<float> all = map.values;
    std::erase_if(all, [](float difference) { return std::isnan(difference); });
    return all;
}

std::vector<float> colour_differences(const ImageF& drawn, const ImageF& truth) {
    return covered_differences(colour_difference_map(drawn, truth));
}

ImageF square_means(const ImageF& picture, int side_px) {
    check_argument(
        picture.channels == 4 && side_px > 0,
        "square_means: a picture with coverage and squares of a pixel or more are needed");
    if (side_px == 1) return picture;
    ImageF means(picture.width / side_px, picture.height / side_px, 4);
    for (int y = 0; y < means.height * side_px; ++y) {
        for (int x = 0; x < means.width * side_px; ++x) {
            const float coverage = picture.at(x, y, 3);
            if (coverage == 0.0f) continue;
            for (int c = 0; c < 3; ++c) {
                means.at(x / side_px, y / side_px, c) += coverage * picture.at(x, y, c);
            }
            means.at(x / side_px, y / side_px, 3) += coverage;
        }
    }
    for (std::size_t i = 0; i < means.values.size(); i += 4) {
        float* mean = &means.values[i];
        for (int c = 0; c < 3 && mean[3] > 0.0f; ++c) mean[c] /= mean[3];
        mean[3] /= static_cast<float>(side_px * side_px);
    }
    return means;
}

}  // namespace livery
