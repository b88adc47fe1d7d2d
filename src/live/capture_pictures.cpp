#include "live/capture_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/colour.h"
#include "core/pictures/white_balance.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

constexpr double kWhite = 0.9;     ///< of full scale
constexpr double kClipped = 0.98;  ///< of full scale
constexpr std::size_t kLookedAt = 60000;

void normalise(CaptureHistogram& histogram) {
    // What lies in the dark around the mock-up would leave nothing of the rest.
    const float most = *std::max_element(histogram.share.begin() + 1, histogram.share.end());
    for (float& share : histogram.share) share = std::min(1.0f, most > 0.0f ? share / most : share);
}

std::size_t bin_of(double share_of_full_scale) {
    return static_cast<std::size_t>(std::clamp(share_of_full_scale, 0.0, 1.0) * 63.0 + 0.5);
}

/// The pixels of a picture made small, each by its place in the large one.
template <typename Pixel>
Image8 thinned(int width, int height, int wanted, const Pixel& pixel) {
    const int step = std::max(1, (width + wanted - 1) / wanted);
    Image8 small(std::max(1, width / step), std::max(1, height / step), 3);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            for (int c = 0; c < 3; ++c) small.at(x, y, c) = pixel(x * step, y * step, step, c);
    return small;
}

}  // namespace

Image8 small_photograph(const Photograph& photograph, int width, const glm::dvec3& balance) {
    const ImageF& image = photograph.image;
    const double full = std::isfinite(photograph.saturates_at)
                            ? photograph.saturates_at - photograph.black_level
                            : 1.0;
    return thinned(image.width, image.height, width, [&](int x, int y, int step, int c) {
        double sum = 0.0;
        int count = 0;
        for (int v = y; v < std::min(y + step, image.height); ++v)
            for (int u = x; u < std::min(x + step, image.width); ++u, ++count)
                sum += static_cast<double>(image.at(u, v, c)) - photograph.black_level;
        const double light = count > 0 ? balance[c] * sum / (count * kWhite * full) : 0.0;
        return static_cast<std::uint8_t>(
            255.0 * srgb_encode(std::clamp(std::isfinite(light) ? light : 0.0, 0.0, 1.0)) + 0.5);
    });
}

Image8 small_picture(const Image8& picture, int width) {
    return thinned(picture.width, picture.height, width, [&](int x, int y, int step, int c) {
        int sum = 0, count = 0;
        for (int v = y; v < std::min(y + step, picture.height); ++v)
            for (int u = x; u < std::min(x + step, picture.width); ++u, ++count)
                sum += picture.at(u, v, c);
        return static_cast<std::uint8_t>(count > 0 ? sum / count : 0);
    });
}

CaptureHistogram histogram_of(const Photograph& photograph) {
    CaptureHistogram histogram;
    if (!std::isfinite(photograph.saturates_at)) return histogram;
    const double full = photograph.saturates_at - photograph.black_level;
    const std::size_t pixels = photograph.image.pixel_count();
    const std::size_t step = std::max<std::size_t>(1, pixels / kLookedAt);
    double clipped = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pixels; i += step) {
        double most = 0.0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::max(
                most,
                static_cast<double>(photograph.image.values[3 * i + c]) - photograph.black_level);
        histogram.share[bin_of(most / full)] += 1.0f;
        clipped += most >= kClipped * full;
        count += 1.0;
    }
    histogram.clipped = clipped / std::max(count, 1.0);
    normalise(histogram);
    return histogram;
}

CaptureHistogram histogram_of(const Image8& srgb) {
    CaptureHistogram histogram;
    const std::size_t pixels = srgb.pixel_count();
    const std::size_t step = std::max<std::size_t>(1, pixels / kLookedAt);
    double clipped = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pixels; i += step) {
        const auto most =
            *std::max_element(srgb.values.begin() + static_cast<std::ptrdiff_t>(3 * i),
                              srgb.values.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
        histogram.share[bin_of(srgb_decode(most / 255.0))] += 1.0f;
        clipped += most >= 253;
        count += 1.0;
    }
    histogram.clipped = clipped / std::max(count, 1.0);
    normalise(histogram);
    return histogram;
}

namespace {

constexpr std::array<std::uint8_t, 3> kOutline{255, 150, 40}, kMeasured{70, 150, 90},
    kPredicted{80, 120, 190}, kMissing{200, 60, 50};

void paint(Image8& picture, int x, int y, const std::array<std::uint8_t, 3>& colour) {
    for (int c = 0; c < 3; ++c) picture.at(x, y, c) = colour[static_cast<std::size_t>(c)];
}

}  // namespace

Image8 outline_on_photograph(const Photograph& photograph,
                             const View& camera,
                             const Mesh& mesh,
                             int width) {
    Image8 picture = small_photograph(photograph, width, white_balance(photograph));
    const Image8 inside = mockup_mask(mesh, resized(camera, picture.width, picture.height));
    for (int y = 1; y < picture.height; ++y)
        for (int x = 1; x < picture.width; ++x) {
            const bool here = inside.at(x, y) != 0;
            if (here != (inside.at(x - 1, y) != 0) || here != (inside.at(x, y - 1) != 0))
                paint(picture, x, y, kOutline);
        }
    return picture;
}

Image8 status_picture(const ColourCalibration& calibration, const Image8& mockup, int width) {
    Image8 picture(calibration.width, calibration.height, 3, 24);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const auto status = static_cast<PixelStatus>(calibration.status.at(x, y));
            if (status == PixelStatus::predicted) {
                paint(picture, x, y, kPredicted);
            } else if (is_valid(status)) {
                paint(picture, x, y, kMeasured);
            } else if (!mockup.empty() && mockup.at(x, y)) {
                paint(picture, x, y, kMissing);
            }
        }
    return small_picture(picture, width);
}

}  // namespace livery
