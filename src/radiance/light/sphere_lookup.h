// Directions: look-ups of an environment without trigonometry of their own, and Vogel's spirals,
// which fill a disc, a cap or a hemisphere evenly, turned for each fragment by an angle of its own
// so that neighbours make different errors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "core/memory.h"
#include "radiance/lanes/lane_functions.h"
#include "radiance/light/environment_filter.h"
#include "scene/look.h"

namespace livery {

/// From one point of a spiral to the next.
inline constexpr double kGoldenAngle_rad = std::numbers::pi * 0.76393202250021030;

/// Two unit vectors that make a right-handed frame with unit `n` (Duff et al. 2017).
struct Basis {
    glm::vec3 s, t;
};
Basis basis_around(const glm::vec3& n);

/// A fragment's angle in [0, 2 pi): hashes of different purposes have nothing in common.
double turn_of_fragment_rad(std::size_t fragment, std::uint32_t purpose, std::uint32_t salt);

/// Points around the z axis, put around `axis` (whose basis_around() is `basis`) and turned about
/// it; as many directions as points.
void turn_around(std::span<const glm::vec3> points,
                 const glm::vec3& axis,
                 const Basis& basis,
                 double turn_rad,
                 std::span<glm::vec3> directions);

/// Four floats as one register holds them: red, green, blue, unused.
using Texel = float __attribute__((vector_size(16)));
inline glm::vec3 rgb_of(const Texel& t) { return {t[0], t[1], t[2]}; }

/// uv_from_direction() in single precision: within 3e-6 of the map's width and height.
class SpherePlaces {
  public:
    explicit SpherePlaces(const Environment& environment);
    glm::vec2 of(const glm::vec3& unit_direction) const;
    /// Of the environment about +y, and half of one.
    float turns() const { return turns_; }

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
    /// For many look-ups at once (lanes/lane_functions.h).
    SphereTexels texels() const;

  private:
    int width_ = 0, height_ = 0;
    std::size_t count_ = 0;
    LargeTable<Texel> texels_;
};

/// An environment's Gaussians, of both sizes. Those that follow one another lie side by side, each
/// such pair in a picture of its own: nodes near one another read it in few places.
class GaussianLayers {
  public:
    explicit GaussianLayers(const FilteredEnvironment& filtered);

    /// For sums over many directions (lanes/lane_functions.h).
    GaussianTexels sharp() const { return sharp_.texels(); }
    GaussianTexels wide() const { return wide_.texels(); }

  private:
    class Pairs {
      public:
        Pairs() = default;
        explicit Pairs(std::span<const ImageF> pictures);
        GaussianTexels texels() const;

      private:
        int width_ = 0, height_ = 0, count_ = 0;
        LargeTable<Texel> texels_;  ///< pair, row, column, which of the two
    };
    Pairs sharp_, wide_;
};

// Inline: once for each of a fragment's lobes and samples.

namespace sphere_lookup_detail {
/// Of the quotients of numbers that are not negative; 0 of two zeros. A polynomial on [0, 1],
/// within 2e-6 rad.
inline float first_quadrant_angle(float y, float x) {
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
}  // namespace sphere_lookup_detail

inline glm::vec2 SpherePlaces::of(const glm::vec3& d) const {
    using sphere_lookup_detail::first_quadrant_angle;
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

inline SphereStack::Footprint SphereStack::at(const glm::vec2& uv) const {
    const float x = uv.x * static_cast<float>(width_) - 0.5f;
    const float y = uv.y * static_cast<float>(height_) - 0.5f;
    // std::floor is a call where the processor may be any. What is no number is read somewhere
    // within, and stays none
    const auto below = [](float v) { return v > -1.0f ? static_cast<int>(v + 1.0f) - 1 : -1; };
    const int column = below(x), row = below(y);
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

}  // namespace livery
