#include "core/pictures/colour_differences.h"

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

}  // namespace livery
