#include "support/radiance_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/worst_error.h"

namespace livery {

RadianceError radiance_error(const ImageF& rendered, const ImageF& truth) {
    check_argument(rendered.width == truth.width && rendered.height == truth.height &&
                       rendered.channels == 4 && truth.channels == 4,
                   fmt::format("pictures of {}x{}x{} and {}x{}x{} cannot be compared",
                               rendered.width,
                               rendered.height,
                               rendered.channels,
                               truth.width,
                               truth.height,
                               truth.channels));
    RadianceError error;
    std::vector<double> differences;
    for (std::size_t i = 0; i < rendered.pixel_count(); ++i) {
        const float* a = &rendered.values[4 * i];
        const float* b = &truth.values[4 * i];
        if (std::min(a[3], b[3]) < 0.5f) continue;
        double largest = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double difference = static_cast<double>(a[c]) - static_cast<double>(b[c]);
            error.mean_signed += difference / 3.0;
            largest = worse_of(largest, std::abs(difference));
        }
        differences.push_back(largest);
    }
    error.pixels = differences.size();
    if (differences.empty()) return error;
    error.mean_signed /= static_cast<double>(differences.size());
    std::sort(differences.begin(), differences.end());
    const auto quantile = [&](double q) {
        return differences[static_cast<std::size_t>(
            std::lround(q * static_cast<double>(differences.size() - 1)))];
    };
    error.median = quantile(0.5);
    error.p90 = quantile(0.9);
    error.p99 = quantile(0.99);
    error.largest = differences.back();
    return error;
}

}  // namespace livery
