#include "radiance/light/sphere_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"

namespace livery {

Basis basis_around(const glm::vec3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

double turn_of_fragment_rad(std::size_t fragment, std::uint32_t purpose, std::uint32_t salt) {
    return 2.0 * std::numbers::pi *
           (hash_3d(static_cast<std::uint32_t>(fragment), purpose, salt) * 0x1p-32);
}

void turn_around(std::span<const glm::vec3> points,
                 const glm::vec3& axis,
                 const Basis& basis,
                 double turn_rad,
                 std::span<glm::vec3> directions) {
    const auto c = static_cast<float>(std::cos(turn_rad));
    const auto s = static_cast<float>(std::sin(turn_rad));
    const glm::vec3 x = c * basis.s + s * basis.t, y = c * basis.t - s * basis.s;
    for (std::size_t k = 0; k < points.size(); ++k) {
        directions[k] = points[k].x * x + points[k].y * y + points[k].z * axis;
    }
}

SpherePlaces::SpherePlaces(const Environment& environment)
    : turns_([&] {
          const double turns = environment.rotation_rad / (2.0 * std::numbers::pi) + 0.5;
          return static_cast<float>(turns - std::floor(turns));
      }()) {}

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

SphereTexels SphereStack::texels() const {
    return {
        reinterpret_cast<const float*>(texels_.data()), width_, height_, static_cast<int>(count_)};
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
