#include "radiance/light/sphere_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace livery {
namespace {

/// Of the quotients of numbers that are not negative; 0 of two zeros. A polynomial on [0, 1],
/// within 2e-6 rad.
float first_quadrant_angle(float y, float x) {
    const float larger = std::max(x, y), smaller = std::min(x, y);
    const float t = smaller / std::max(larger, 1e-30f);
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
    : turns_([&] {
          const double turns = environment.rotation_rad / (2.0 * std::numbers::pi) + 0.5;
          return static_cast<float>(turns - std::floor(turns));
      }()) {}

glm::vec2 SpherePlaces::of(const glm::vec3& d) const {
    constexpr float kPi = std::numbers::pi_v<float>;
    constexpr float kTurn = 0.5f * std::numbers::inv_pi_v<float>;
    // Clockwise from -z
    float azimuth = first_quadrant_angle(std::abs(d.x), std::abs(d.z));
    azimuth = d.z > 0.0f ? kPi - azimuth : azimuth;
    float u = (d.x < 0.0f ? -azimuth : azimuth) * kTurn + turns_;
    u = u >= 1.0f ? u - 1.0f : u;
    u = u < 0.0f ? u + 1.0f : u;
    float polar = first_quadrant_angle(std::sqrt(d.x * d.x + d.z * d.z), std::abs(d.y));
    polar = d.y < 0.0f ? kPi - polar : polar;
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

GaussianLayers::Pairs::Pairs(std::span<const ImageF> pictures)
    : width_(pictures.front().width),
      height_(pictures.front().height),
      count_(static_cast<int>(pictures.size())) {
    const std::size_t texels = pictures.front().pixel_count(), pairs = pictures.size() - 1;
    texels_.resize(2 * pairs * texels);
    const auto rgb_of = [&](std::size_t picture, std::size_t i) {
        const float* rgb = &pictures[picture].values[3 * i];
        return Texel{rgb[0], rgb[1], rgb[2], 0.0f};
    };
    parallel_for(pairs * texels, 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t at = begin; at < end; ++at) {
            const std::size_t pair = at / texels, i = at % texels;
            texels_[2 * at] = rgb_of(pair, i);
            texels_[2 * at + 1] = rgb_of(pair + 1, i);
        }
    });
}

GaussianTexels GaussianLayers::Pairs::texels() const {
    return {reinterpret_cast<const float*>(texels_.data()), width_, height_, count_};
}

GaussianLayers::GaussianLayers(const FilteredEnvironment& filtered) {
    const auto& all = filtered.gaussians;
    const auto other_size = std::find_if(all.begin(), all.end(), [&](const ImageF& picture) {
        return picture.width != all.front().width;
    });
    const auto sharp_count = static_cast<std::size_t>(other_size - all.begin());
    const std::span<const ImageF> pictures(all);
    sharp_ = Pairs(pictures.first(sharp_count));
    wide_ = Pairs(pictures.subspan(sharp_count));
}

}  // namespace livery
