#include "scene/artwork_cover.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/mutation.h"

#define REAL Real
#define VEC2 Vec2
#define R(x) static_cast<Real>(x)
#define FN inline

namespace livery {

namespace {

namespace cover_f32 {
using Real = float;
using Vec2 = glm::vec2;
using glm::abs, glm::clamp, glm::floor, glm::max, glm::mix, glm::sqrt;
#include "shaders/artwork/cover.glsl"
}  // namespace cover_f32

namespace cover_f64 {
using Real = double;
using Vec2 = glm::dvec2;
using glm::abs, glm::clamp, glm::floor, glm::max, glm::mix, glm::sqrt;
#include "shaders/artwork/cover.glsl"
}  // namespace cover_f64

/// Halves both sides. Beyond an odd one lies nothing, or the picture again, which then is one texel
/// wide: its own mean.
ImageF halved(const ImageF& image, bool repeat) {
    ImageF half((image.width + 1) / 2, (image.height + 1) / 2, image.channels);
    const float weight =
        (repeat && image.width == 1 ? 1.0f : 0.5f) * (repeat && image.height == 1 ? 1.0f : 0.5f);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* from = image.pixel(x, y);
            float* to = half.pixel(x / 2, y / 2);
            for (int c = 0; c < image.channels; ++c) to[c] += weight * from[c];
        }
    }
    return half;
}

int next_power_of_two(int size) {
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(size)));
}

ImageF stretched(const ImageF& image, int width, int height) {
    ImageF result(width, height, image.channels);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double u = (x + 0.5) * image.width / width - 0.5;
            const double v = (y + 0.5) * image.height / height - 0.5;
            const int left = static_cast<int>(std::floor(u)), top = static_cast<int>(std::floor(v));
            const auto s = static_cast<float>(u - left), t = static_cast<float>(v - top);
            const auto at = [&](int i, int j) {
                return image.pixel((i + image.width) % image.width,
                                   (j + image.height) % image.height);
            };
            for (int c = 0; c < image.channels; ++c) {
                const float upper = glm::mix(at(left, top)[c], at(left + 1, top)[c], s);
                const float lower = glm::mix(at(left, top + 1)[c], at(left + 1, top + 1)[c], s);
                result.at(x, y, c) = glm::mix(upper, lower, t);
            }
        }
    }
    return result;
}

struct Ellipse {
    double least = 0.0, most = 0.0;  ///< variances along its axes, in texels squared
    glm::dvec2 long_axis{1.0, 0.0};
};

/// Of a parallelogram of these sides: each is a box of variance 1/12.
Ellipse ellipse_of(const glm::dvec2& a, const glm::dvec2& b) {
    const double xx = (a.x * a.x + b.x * b.x) / 12.0, yy = (a.y * a.y + b.y * b.y) / 12.0;
    const double xy = (a.x * a.y + b.x * b.y) / 12.0;
    const double mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
    const double root = std::sqrt(half * half + xy * xy);
    Ellipse ellipse{std::max(mean - root, 0.0), mean + root, {1.0, 0.0}};
    if (root > 1e-12 * mean) {
        const double angle = 0.5 * std::atan2(xy, half);
        ellipse.long_axis = {std::cos(angle), std::sin(angle)};
    }
    return ellipse;
}

constexpr int kVanishing = 10;           // levels beyond a single texel
constexpr double kLeastVariance = 0.25;  // of a texel: neighbours run into one another
constexpr double kMostRatio = 16.0;      // of the axes
constexpr double kReach = 2.5;           // standard deviations

}  // namespace

double shape_cover(const Artwork& artwork,
                   const glm::dvec2& at,
                   const glm::dvec2& a,
                   const glm::dvec2& b) {
    check_argument(artwork.shape != ArtworkShape::picture, "a picture has no shape of its own");
    return cover_f64::shape_cover(static_cast<int>(artwork.shape),
                                  at,
                                  a,
                                  b,
                                  artwork.size_mm,
                                  artwork.share,
                                  artwork.softness_mm);
}

float shape_cover(const Artwork& artwork,
                  const glm::vec2& at,
                  const glm::vec2& a,
                  const glm::vec2& b) {
    check_argument(artwork.shape != ArtworkShape::picture, "a picture has no shape of its own");
    return cover_f32::shape_cover(static_cast<int>(artwork.shape),
                                  at,
                                  a,
                                  b,
                                  static_cast<float>(artwork.size_mm),
                                  static_cast<float>(artwork.share),
                                  static_cast<float>(artwork.softness_mm));
}

double facing_cover(const ArtworkPlace& place, double cosine) {
    return place.through || place.by_uv ? 1.0 : cover_f64::facing_cover(cosine);
}

FilteredPicture::FilteredPicture(const ImageF& picture, bool repeat) : repeat_(repeat) {
    check_argument(!picture.empty(), "an artwork's picture is empty");
    const int width = next_power_of_two(picture.width), height = next_power_of_two(picture.height);
    const bool resample = repeat && (width != picture.width || height != picture.height);
    levels_.push_back(resample ? stretched(picture, width, height) : picture);
    size_ = {levels_.front().width, levels_.front().height};
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        levels_.push_back(halved(levels_.back(), repeat));
    }
    // Of a picture that is small in its footprint less and less is left
    for (int k = 0; !repeat && k < kVanishing; ++k) {
        levels_.push_back(halved(levels_.back(), repeat));
    }
}

const ImageF& FilteredPicture::level_within(int side) const {
    for (const ImageF& level : levels_) {
        if (std::max(level.width, level.height) <= side) return level;
    }
    return levels_.back();
}

const float* FilteredPicture::texel(const ImageF& level, int x, int y) const {
    if (repeat_) {
        x = ((x % level.width) + level.width) % level.width;
        y = ((y % level.height) + level.height) % level.height;
    } else if (x < 0 || y < 0 || x >= level.width || y >= level.height) {
        return nullptr;
    }
    return level.pixel(x, y);
}

void FilteredPicture::mean(const glm::dvec2& uv,
                           const glm::dvec2& a,
                           const glm::dvec2& b,
                           float* out) const {
    const int count = channels();
    std::fill(out, out + count, 0.0f);
    Ellipse ellipse = ellipse_of(a * size_, b * size_);
    ellipse.least = std::max(ellipse.least, ellipse.most / (kMostRatio * kMostRatio));

    // The level on which the short axis is about a texel
    const double wanted = 0.5 * std::log2(std::max(ellipse.least / kLeastVariance, 1.0));
    const auto last = static_cast<double>(levels_.size()) - 1.0;
    const int index = static_cast<int>(std::min(wanted, last));
    const ImageF& level = levels_[static_cast<std::size_t>(index)];
    if (wanted > last + 1.0) {
        if (repeat_) std::copy_n(level.values.data(), count, out);
        return;
    }
    const double scale = std::exp2(-index);
    const double least = std::max(ellipse.least * scale * scale, kLeastVariance);
    const double most = std::max(ellipse.most * scale * scale, kLeastVariance);
    glm::dvec2 centre = uv;
    if (repeat_) centre -= glm::floor(centre);
    centre *= size_ * scale;
    if (!std::isfinite(centre.x) || !std::isfinite(centre.y)) return;

    // Over the ellipse's box
    const glm::dvec2 axis = ellipse.long_axis;
    const glm::dvec2 spread = glm::sqrt(most * axis * axis + least * glm::dvec2(axis.y, axis.x) *
                                                                 glm::dvec2(axis.y, axis.x));
    const glm::dvec2 reach = kReach * spread;
    if (!repeat_ && (centre.x + reach.x < 0.0 || centre.y + reach.y < 0.0 ||
                     centre.x - reach.x > level.width || centre.y - reach.y > level.height)) {
        return;
    }
    const int left = static_cast<int>(std::floor(centre.x - reach.x));
    const int right = static_cast<int>(std::floor(centre.x + reach.x));
    const int top = static_cast<int>(std::floor(centre.y - reach.y));
    const int bottom = static_cast<int>(std::floor(centre.y + reach.y));
    double total = 0.0;
    for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x) {
            const glm::dvec2 d = glm::dvec2(x + 0.5, y + 0.5) - centre;
            const double along = glm::dot(d, axis), across = d.y * axis.x - d.x * axis.y;
            const double distance2 = along * along / most + across * across / least;
            if (distance2 > kReach * kReach) continue;
            const double weight = std::exp(-0.5 * distance2);
            total += weight;
            const float* from = texel(level, x, y);
            if (!from) continue;
            for (int c = 0; c < count; ++c) out[c] += static_cast<float>(weight) * from[c];
        }
    }
    if (total > 0.0) {
        for (int c = 0; c < count; ++c) out[c] /= static_cast<float>(total);
    }
}

ReliefFrame relief_frame(const PartArtwork& relief,
                         const glm::dvec3& normal,
                         const glm::dvec4& tangent) {
    const ArtworkPlane plane = plane_of(relief.artwork.place);
    const bool by_uv = relief.artwork.place.by_uv;
    glm::dvec3 right = by_uv ? glm::dvec3(tangent) : plane.s_axis;
    right -= glm::dot(right, normal) * normal;
    // Where the plane stands on edge its right is the other direction across its up
    if (glm::dot(right, right) < 1e-12) right = glm::cross(plane.t_axis, normal);
    right = glm::normalize(right);
    glm::dvec3 up = glm::cross(normal, right);
    if (by_uv ? tangent.w < 0.0 : glm::dot(up, plane.t_axis) < 0.0) up = -up;
    return {right, up};
}

ReliefTilt tilt_of(const PartArtwork& relief, const glm::dvec4& mean) {
    const double depth = relief.artwork.depth;
    const glm::dvec2 slope(mean);
    return {depth * slope, depth * depth * std::max(mean.z - glm::dot(slope, slope), 0.0)};
}

ReliefTilt tilt_at(const PartArtwork& relief, const ArtworkPoint& point) {
    const glm::dvec2 slope = relief_slope(&point.rgba.x);
    return {relief.artwork.depth * point.cover * slope, 0.0};
}

glm::dvec3 tilted(const glm::dvec3& normal, const ReliefFrame& frame, const glm::dvec2& slope) {
    return glm::normalize(normal + slope.x * frame.right + slope.y * frame.up);
}

}  // namespace livery
