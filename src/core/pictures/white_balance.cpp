#include "core/pictures/white_balance.h"

#include <cstddef>
#include <vector>

#include <glm/common.hpp>

#include "core/statistics.h"

namespace livery {

glm::dvec3 white_balance(const Photograph& white) {
    constexpr double kLargestGain = 4.0;
    constexpr std::size_t kLookedAt = 60000;
    const std::size_t pixels = white.image.pixel_count();
    const std::size_t step = std::max<std::size_t>(1, pixels / kLookedAt);
    std::vector<float> green;
    for (std::size_t i = 0; i < pixels; i += step) green.push_back(white.image.values[3 * i + 1]);
    if (green.empty()) return glm::dvec3(1.0);
    const float black = static_cast<float>(white.black_level);
    const float lit = 0.5f * (quantile(green, 0.995) - black);
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < pixels; i += step) {
        const float* const rgb = &white.image.values[3 * i];
        if (!(rgb[1] - black > lit)) continue;
        for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(rgb[c] - black);
    }
    if (!(sum.y > 0.0)) return glm::dvec3(1.0);
    const glm::dvec3 gains = sum.y / glm::max(sum, glm::dvec3(1e-9 * sum.y));
    return glm::clamp(gains, glm::dvec3(1.0 / kLargestGain), glm::dvec3(kLargestGain));
}

}  // namespace livery
