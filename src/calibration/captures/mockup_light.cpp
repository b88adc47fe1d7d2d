#include "calibration/captures/mockup_light.h"

#include <algorithm>
#include <cmath>

#include "core/statistics.h"

namespace livery {

namespace {

/// Pixels within reach of the mock-up: a pose that is a little off, a lens that is a little soft.
Image8 around(const Image8& mockup) {
    const int reach = std::max(2, mockup.width / 200);
    Image8 rows(mockup.width, mockup.height, 1), all = rows;
    const auto spread = [&](const Image8& from, Image8& to, int dx, int dy) {
        for (int y = 0; y < from.height; ++y)
            for (int x = 0; x < from.width; ++x) {
                if (!from.at(x, y)) continue;
                for (int k = -reach; k <= reach; ++k) {
                    const int u = x + k * dx, v = y + k * dy;
                    if (u >= 0 && v >= 0 && u < to.width && v < to.height) to.at(u, v) = 255;
                }
            }
    };
    spread(mockup, rows, 1, 0);
    spread(rows, all, 0, 1);
    return all;
}

}  // namespace

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

ShowPicture shown_on(const Image8& mockup, const ShowPicture& show) {
    return [lit = around(mockup), show](const Image8& drive) {
        Image8 alone = drive;
        for (std::size_t i = 0; i < alone.pixel_count(); ++i)
            if (!lit.values[i])
                std::fill_n(
                    alone.values.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, std::uint8_t{0});
        show(alone);
    };
}

}  // namespace livery
