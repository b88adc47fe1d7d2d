// Many look-ups of an environment: directions to places on its map without trigonometry of the
// library's, and all of its Gaussians side by side.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "radiance/light/environment_filter.h"
#include "scene/look.h"

namespace livery {

/// Four floats as one register holds them: red, green, blue, unused.
using Texel = float __attribute__((vector_size(16)));
inline glm::vec3 rgb_of(const Texel& t) { return {t[0], t[1], t[2]}; }

/// uv_from_direction() in single precision: within 3e-6 of the map's width and height.
class SpherePlaces {
  public:
    explicit SpherePlaces(const Environment& environment);
    glm::vec2 of(const glm::vec3& unit_direction) const;
    /// Four at a time.
    struct Four {
        Texel u, v;
    };
    Four of(const Texel& x, const Texel& y, const Texel& z) const;

  private:
    float turns_;
};

/// Pictures of the whole sphere and of one size, texel beside texel; bilinear, wrapped in azimuth.
class SphereStack {
  public:
    SphereStack() = default;
    explicit SphereStack(std::span<const ImageF> pictures);

    /// The four texels around a place, found once for all pictures.
    struct Footprint {
        std::array<const Texel*, 4> texel;
        std::array<float, 4> weight;
        Texel in(std::size_t picture) const {
            const auto share = [&](std::size_t k) {
                const float w = weight[k];
                return Texel{w, w, w, w} * texel[k][picture];
            };
            return (share(0) + share(1)) + (share(2) + share(3));
        }
    };
    Footprint at(const glm::vec2& uv) const;

  private:
    int width_ = 0, height_ = 0;
    std::size_t count_ = 0;
    std::vector<Texel> texels_;
};

/// An environment's Gaussians, of both sizes.
class GaussianLayers {
  public:
    explicit GaussianLayers(const FilteredEnvironment& filtered);

    /// Under a Gaussian of that variance along each axis, rad^2: two layers mixed so that the
    /// variance is right.
    Texel at(const glm::vec2& uv, float variance) const;

  private:
    std::size_t sharp_count_ = 0, count_ = 0;
    SphereStack sharp_, wide_;
};

// Inline: once for each of a fragment's lobes and samples.

inline SphereStack::Footprint SphereStack::at(const glm::vec2& uv) const {
    const float x = uv.x * static_cast<float>(width_) - 0.5f;
    const float y = uv.y * static_cast<float>(height_) - 0.5f;
    // Neither is under -1; std::floor is a call where the processor may be any
    const int column = static_cast<int>(x + 1.0f) - 1, row = static_cast<int>(y + 1.0f) - 1;
    const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);
    const auto wrapped = [&](int c) {
        return static_cast<std::size_t>(c < 0 ? c + width_ : c >= width_ ? c - width_ : c);
    };
    const auto line = [&](int r) {
        return static_cast<std::size_t>(std::clamp(r, 0, height_ - 1)) *
               static_cast<std::size_t>(width_);
    };
    const auto texel = [&](std::size_t at) { return &texels_[at * count_]; };
    const std::size_t left = wrapped(column), right = wrapped(column + 1);
    const std::size_t upper = line(row), lower = line(row + 1);
    return {{texel(upper + left), texel(upper + right), texel(lower + left), texel(lower + right)},
            {(1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy, fx * fy}};
}

inline Texel GaussianLayers::at(const glm::vec2& uv, float variance) const {
    constexpr float kPerFirst = 1.0f / (kFirstGaussian_rad * kFirstGaussian_rad);
    // Variances double from layer to layer: the exponent is the layer, the mantissa the share
    const float ratio = std::max(variance * kPerFirst, 0.0f);
    std::size_t below = 0;
    float share = ratio;
    if (ratio >= 1.0f) {
        const auto bits = std::bit_cast<std::uint32_t>(ratio);
        below = (bits >> 23u) - 126u;
        share = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u) - 1.0f;
        if (below + 1 >= count_) {
            below = count_ - 2;
            share = 1.0f;
        }
    }
    const float rest = 1.0f - share;
    const Texel of_below{rest, rest, rest, rest}, of_above{share, share, share, share};
    if (below + 1 < sharp_count_) {
        const SphereStack::Footprint place = sharp_.at(uv);
        return of_below * place.in(below) + of_above * place.in(below + 1);
    }
    const SphereStack::Footprint place = wide_.at(uv);
    const Texel above = of_above * place.in(below + 1 - sharp_count_);
    if (below >= sharp_count_) return of_below * place.in(below - sharp_count_) + above;
    return of_below * sharp_.at(uv).in(below) + above;
}

}  // namespace livery
