#include "radiance/sphere_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace livery {
namespace {

/// Of the quotient of two numbers that are not negative; 0 of two zeros. A polynomial on [0, 1],
/// within 2e-6 rad.
float first_quadrant_angle(float y, float x) {
    const float larger = std::max(x, y), smaller = std::min(x, y);
    const float t = larger > 0.0f ? smaller / larger : 0.0f;
    const float t2 = t * t;
    float p = -0.01172120f;
    p = p * t2 + 0.05265332f;
    p = p * t2 - 0.11643287f;
    p = p * t2 + 0.19354346f;
    p = p * t2 - 0.33262347f;
    p = p * t2 + 0.99997726f;
    const float angle = p * t;
    return y > x ? 0.5f * std::numbers::pi_v<float> - angle : angle;
}

}  // namespace

SpherePlaces::SpherePlaces(const Environment& environment)
    : turns_(static_cast<float>(environment.rotation_rad / (2.0 * std::numbers::pi) + 0.5)) {}

glm::vec2 SpherePlaces::of(const glm::vec3& d) const {
    constexpr float kTurn = 0.5f * std::numbers::inv_pi_v<float>;
    // Clockwise from -z
    float azimuth = first_quadrant_angle(std::abs(d.x), std::abs(d.z));
    if (d.z > 0.0f) azimuth = std::numbers::pi_v<float> - azimuth;
    float u = std::copysign(azimuth, d.x) * kTurn + turns_;
    u -= std::floor(u);
    float polar = first_quadrant_angle(std::sqrt(d.x * d.x + d.z * d.z), std::abs(d.y));
    if (d.y < 0.0f) polar = std::numbers::pi_v<float> - polar;
    return {u, polar * std::numbers::inv_pi_v<float>};
}

SphereStack::SphereStack(std::span<const ImageF> pictures)
    : width_(pictures.front().width), height_(pictures.front().height), count_(pictures.size()) {
    texels_.resize(pictures.front().pixel_count() * count_);
    parallel_for(static_cast<std::size_t>(height_), 16, [&](std::size_t begin, std::size_t end) {
        const auto columns = static_cast<std::size_t>(width_);
        for (std::size_t i = begin * columns; i < end * columns; ++i) {
            for (std::size_t k = 0; k < count_; ++k) {
                const float* rgb = &pictures[k].values[3 * i];
                texels_[i * count_ + k] = Texel{rgb[0], rgb[1], rgb[2], 0.0f};
            }
        }
    });
}

MirroredLayers::MirroredLayers(const FilteredEnvironment& filtered) {
    const auto& all = filtered.mirrored;
    const auto other_size = std::find_if(all.begin(), all.end(), [&](const ImageF& picture) {
        return picture.width != all.front().width;
    });
    sharp_count_ = static_cast<std::size_t>(other_size - all.begin());
    const std::span<const ImageF> pictures(all);
    sharp_ = SphereStack(pictures.first(sharp_count_));
    wide_ = SphereStack(pictures.subspan(sharp_count_));
}

}  // namespace livery
