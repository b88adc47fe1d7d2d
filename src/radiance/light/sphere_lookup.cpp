#include "radiance/light/sphere_lookup.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace livery {
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
