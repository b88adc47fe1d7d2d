// Many look-ups of an environment: directions to places on its map without trigonometry of the
// library's, and all of its mirrored layers side by side.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "radiance/environment_filter.h"
#include "scene/look.h"

namespace livery {

/// uv_from_direction() in single precision: within 3e-6 of the map's width and height.
class SpherePlaces {
  public:
    explicit SpherePlaces(const Environment& environment);
    glm::vec2 of(const glm::vec3& unit_direction) const;

  private:
    float turns_;
};

/// Four floats as one register holds them: red, green, blue, unused.
using Texel = float __attribute__((vector_size(16)));
inline glm::vec3 rgb_of(const Texel& t) { return {t[0], t[1], t[2]}; }

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

/// An environment's mirrored layers, of both sizes.
class MirroredLayers {
  public:
    explicit MirroredLayers(const FilteredEnvironment& filtered);

    /// Interpolated between the layers to either side of alpha, as sample_layers().
    class Place {
      public:
        Place(const MirroredLayers& layers, const glm::vec2& uv) : layers_(layers), uv_(uv) {}
        Texel with(float alpha) const;

      private:
        Texel layer(std::size_t k) const;

        const MirroredLayers& layers_;
        glm::vec2 uv_;
        mutable SphereStack::Footprint sharp_, wide_;
        mutable bool found_sharp_ = false, found_wide_ = false;
    };

  private:
    std::size_t sharp_count_ = 0;
    SphereStack sharp_, wide_;
};

// Inline: once for each of a fragment's lobes and samples.

inline SphereStack::Footprint SphereStack::at(const glm::vec2& uv) const {
    const float x = uv.x * static_cast<float>(width_) - 0.5f;
    const float y = uv.y * static_cast<float>(height_) - 0.5f;
    const float x_floor = std::floor(x), y_floor = std::floor(y);
    const float fx = x - x_floor, fy = y - y_floor;
    const int column = static_cast<int>(x_floor), row = static_cast<int>(y_floor);
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

inline Texel MirroredLayers::Place::layer(std::size_t k) const {
    if (k < layers_.sharp_count_) {
        if (!std::exchange(found_sharp_, true)) sharp_ = layers_.sharp_.at(uv_);
        return sharp_.in(k);
    }
    if (!std::exchange(found_wide_, true)) wide_ = layers_.wide_.at(uv_);
    return wide_.in(k - layers_.sharp_count_);
}

inline Texel MirroredLayers::Place::with(float alpha) const {
    const auto [below, share] = layer_of(alpha);
    const float rest = 1.0f - share;
    return Texel{rest, rest, rest, rest} * layer(below) +
           Texel{share, share, share, share} * layer(below + 1);
}

}  // namespace livery
