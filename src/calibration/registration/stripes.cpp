#include "calibration/registration/stripes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "core/error.h"
#include "core/random.h"
#include "core/statistics.h"

namespace livery {

namespace {

/// Less light than this share of the brightest is noise and scatter.
constexpr float kLeastLight = 0.05f;
/// What the signal must change by over three pixels: it goes from -1 to 1 in a dark room, half of
/// that where the room sends as much light as a third of the projector's.
constexpr float kLeastStep = 0.4f;

ImageF linear_light(const Photograph& photograph) {
    ImageF mean = mean_of_channels(photograph.image);
    for (float& value : mean.values)
        value = static_cast<float>(linear_from_file_units(photograph, static_cast<double>(value)));
    return mean;
}

/// Where the signal goes through zero between a pixel and the next one along the way, as a part of
/// their distance; negative: it does not, or what changes there is no border of a stripe.
float zero_after(const ImageF& signal, int x, int y, bool down) {
    const auto at = [&](int k) { return down ? signal.at(x, y + k) : signal.at(x + k, y); };
    const float before = at(0), after = at(1);
    if (!std::isfinite(before) || !std::isfinite(after)) return -1.0f;
    if ((before < 0.0f) == (after < 0.0f)) return -1.0f;
    const float outer_before = at(-1), outer_after = at(2);
    const bool border = (outer_before < 0.0f) == (before < 0.0f) &&
                        (outer_after < 0.0f) == (after < 0.0f) &&
                        std::abs(outer_after - outer_before) > kLeastStep;
    return border ? before / (before - after) : -1.0f;
}

}  // namespace

double StripeCode::mean_stripe_px() const {
    return static_cast<double>(rows ? height : width) / static_cast<double>(edges.size() + 1);
}

double StripeCode::nearest_edge(double across_px, bool rising) const {
    const auto after = std::lower_bound(edges.begin(), edges.end(), across_px);
    const auto place = static_cast<std::ptrdiff_t>(after - edges.begin());
    double best = std::numeric_limits<double>::infinity();
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, place - 2);
         k < std::min(static_cast<std::ptrdiff_t>(edges.size()), place + 2);
         ++k) {
        if ((k % 2 == 0) != rising) continue;
        const double edge = edges[static_cast<std::size_t>(k)];
        if (std::abs(edge - across_px) < std::abs(best - across_px)) best = edge;
    }
    return best;
}

StripeCode stripe_code(int width, int height, bool rows) {
    check_pattern_size(width, height);
    StripeCode code{width, height, rows, {}};
    const double mean = std::max(4.0, width / 80.0);
    Random random(1, 11);  // the same stripes for ever: photographs are taken of them
    const int end = rows ? height : width;
    for (double place = mean;; place += mean * (1.0 + (2.0 * random.uniform() - 1.0) / 3.0)) {
        const int edge = static_cast<int>(std::lround(place));
        if (edge >= end - 1) break;
        code.edges.push_back(edge);
    }
    return code;
}

bool wants_rows(const View& projector, const View& camera, const glm::dvec3& middle_mm) {
    const glm::dvec3 from = centre_in_world(camera);
    const auto near = project(projector, middle_mm);
    const auto far = project(projector, middle_mm + 0.01 * (middle_mm - from));
    if (!near || !far) return false;
    return std::abs(far->y - near->y) > std::abs(far->x - near->x);
}

std::string stripe_role(bool inverse) { return inverse ? "repose-inverse" : "repose"; }

Image8 stripe_picture(const StripeCode& code, bool inverse) {
    Image8 picture(code.width, code.height, 3);
    for (int y = 0; y < code.height; ++y)
        for (int x = 0; x < code.width; ++x) {
            const auto stripe =
                std::upper_bound(code.edges.begin(), code.edges.end(), code.rows ? y : x) -
                code.edges.begin();
            const std::uint8_t drive = (stripe % 2 == 1) != inverse ? 255 : 0;
            std::fill_n(picture.pixel(x, y), 3, drive);
        }
    return picture;
}

double StripeSight::offset_of(const glm::dvec2& camera_px, bool rising, double within_px) const {
    double best = std::numeric_limits<double>::quiet_NaN();
    const int line = static_cast<int>(std::floor(down ? camera_px.x : camera_px.y));
    const double along = (down ? camera_px.y : camera_px.x) - 0.5;
    const int length = down ? signal.height : signal.width;
    if (line < 0 || line >= (down ? signal.width : signal.height)) return best;
    const int first = std::max(1, static_cast<int>(std::floor(along - within_px)));
    const int last = std::min(length - 3, static_cast<int>(std::ceil(along + within_px)));
    for (int k = first; k <= last; ++k) {
        const int x = down ? line : k, y = down ? k : line;
        const float part = zero_after(signal, x, y, down);
        if (part < 0.0f) continue;
        if (((signal.at(x, y) < 0.0f) == grows) != rising) continue;
        const double offset = k + static_cast<double>(part) - along;
        if (std::abs(offset) <= within_px && !(std::abs(offset) >= std::abs(best))) best = offset;
    }
    return best;
}

StripeSight see_stripes(const Photograph& stripes,
                        const Photograph& inverse,
                        const glm::dvec2& uphill) {
    const ImageF a = linear_light(stripes), b = linear_light(inverse);
    if (a.width != b.width || a.height != b.height)
        throw FileError("the camera's photographs",
                        "size",
                        fmt::format("{}x{}", b.width, b.height),
                        fmt::format("{}x{}, as the first", a.width, a.height));
    std::vector<float> sums(a.values.size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = a.values[i] + b.values[i];
    const float least = kLeastLight * quantile(sums, 0.99);
    if (!(least > 0.0f))
        throw Refused("no light of the projector is seen",
                      "take the cap off the lens, and see whether the projector shows pictures");
    StripeSight sight;
    sight.signal = ImageF(a.width, a.height, 1, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i] > least) sight.signal.values[i] = (a.values[i] - b.values[i]) / sums[i];
    sight.down = std::abs(uphill.y) > std::abs(uphill.x);
    sight.grows = (sight.down ? uphill.y : uphill.x) > 0.0;
    const int right = a.width - (sight.down ? 0 : 2), bottom = a.height - (sight.down ? 2 : 0);
    for (int y = sight.down ? 1 : 0; y < bottom; ++y)
        for (int x = sight.down ? 0 : 1; x < right; ++x) {
            const float part = zero_after(sight.signal, x, y, sight.down);
            if (part < 0.0f) continue;
            const double along = 0.5 + static_cast<double>(part);
            sight.crossings.push_back(
                {sight.down ? glm::dvec2(x + 0.5, y + along) : glm::dvec2(x + along, y + 0.5),
                 (sight.signal.at(x, y) < 0.0f) == sight.grows});
        }
    return sight;
}

}  // namespace livery
