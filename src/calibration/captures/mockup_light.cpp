#include "calibration/captures/mockup_light.h"

#include <algorithm>
#include <cmath>

#include "core/statistics.h"

namespace livery {

ImageF light_over_black(const Photograph& photograph, const Photograph& black) {
    const auto scale = static_cast<float>(1.0 / (3.0 * photograph.exposure_s));
    const auto black_scale = static_cast<float>(1.0 / (3.0 * black.exposure_s));
    const auto level = static_cast<float>(photograph.black_level);
    const auto black_level = static_cast<float>(black.black_level);
    ImageF light(photograph.image.width, photograph.image.height, 1);
    for (std::size_t i = 0; i < light.values.size(); ++i) {
        float sum = 0.0f;
        for (std::size_t c = 0; c < 3; ++c)
            sum += scale * (photograph.image.values[3 * i + c] - level) -
                   black_scale * (black.image.values[3 * i + c] - black_level);
        light.values[i] = std::isfinite(sum) ? sum : 0.0f;
    }
    return light;
}

LitPixels lit_pixels(const ImageF& light, std::size_t thinned_to) {
    const float limit = 0.1f * quantile(light.values, 0.9999);
    LitPixels all;
    for (std::size_t i = 0; i < light.values.size(); ++i)
        if (light.values[i] > limit) all.push_back(static_cast<std::uint32_t>(i));
    if (thinned_to == 0 || all.size() <= thinned_to) return all;
    LitPixels some;
    const std::size_t step = all.size() / thinned_to + 1;
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    return some;
}

double lit_mean(const ImageF& light, const LitPixels& lit) {
    double sum = 0.0;
    for (const std::uint32_t i : lit) sum += static_cast<double>(light.values[i]);
    return lit.empty() ? 0.0 : sum / static_cast<double>(lit.size());
}

}  // namespace livery
