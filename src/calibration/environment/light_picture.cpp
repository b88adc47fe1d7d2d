#include "calibration/environment/light_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "scene/look.h"

namespace livery {

LightPicture light_of(const MergedPhotographs& merged, const glm::dvec3& clipped_light) {
    const ImageF& counts = merged.counts;
    LightPicture picture;
    picture.light = ImageF(counts.width, counts.height, 3);
    picture.saturated = Image8(counts.width, counts.height, 1);
    picture.left_out = Image8(counts.width, counts.height, 1);
    for (std::size_t k = 0; k < counts.pixel_count(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float seconds = merged.seconds.values[3 * k + c];
            if (seconds > 0.0f) {
                picture.light.values[3 * k + c] = counts.values[3 * k + c] / seconds;
            } else {
                picture.light.values[3 * k + c] =
                    static_cast<float>(clipped_light[static_cast<int>(c)]);
                picture.saturated.values[k] = 1;
            }
        }
    }
    return picture;
}

std::optional<SampledLight> sample(const LightPicture& picture,
                                   const glm::dvec2& pixel,
                                   bool wraps) {
    const int width = picture.light.width, height = picture.light.height;
    // Around a panorama the last half pixel's neighbour is the first; above and below nothing is.
    const double x = pixel.x - 0.5;
    const double y = wraps ? std::clamp(pixel.y - 0.5, 0.0, height - 1.0) : pixel.y - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    SampledLight result;
    for (int v = 0; v < 2; ++v) {
        for (int u = 0; u < 2; ++u) {
            const double weight =
                (u == 0 ? 1.0 - (x - x0) : x - x0) * (v == 0 ? 1.0 - (y - y0) : y - y0);
            if (weight <= 0.0) continue;
            int column = static_cast<int>(x0) + u;
            const int row = static_cast<int>(y0) + v;
            if (wraps) column = (column % width + width) % width;
            if (column < 0 || column >= width || row < 0 || row >= height) return std::nullopt;
            if (picture.left_out.at(column, row) != 0) return std::nullopt;
            const float* light = picture.light.pixel(column, row);
            result.light += weight * glm::dvec3(light[0], light[1], light[2]);
            if (picture.saturated.at(column, row) != 0) result.saturated += weight;
        }
    }
    return result;
}

namespace {

constexpr double kLeastApart_rad = 10.0 * std::numbers::pi / 180.0,
                 kLargestResidual_rad = 10.0 * std::numbers::pi / 180.0;

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Columns: bisector, across it in the plane of both, normal to the plane.
glm::dmat3 frame_of(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 middle = glm::normalize(a + b), normal = glm::normalize(glm::cross(a, b));
    return {middle, glm::cross(normal, middle), normal};
}

}  // namespace

glm::dmat3 world_from_panorama(double yaw_rad, double pitch_rad, double roll_rad) {
    const double cy = std::cos(yaw_rad), sy = std::sin(yaw_rad);
    const double cp = std::cos(pitch_rad), sp = std::sin(pitch_rad);
    const double cr = std::cos(roll_rad), sr = std::sin(roll_rad);
    const glm::dmat3 yaw({cy, 0.0, -sy}, {0.0, 1.0, 0.0}, {sy, 0.0, cy});
    const glm::dmat3 pitch({1.0, 0.0, 0.0}, {0.0, cp, sp}, {0.0, -sp, cp});
    const glm::dmat3 roll({cr, -sr, 0.0}, {sr, cr, 0.0}, {0.0, 0.0, 1.0});
    return yaw * pitch * roll;
}

PanoramaOrientation orientation_of(const PanoramaMark& first,
                                   const PanoramaMark& second,
                                   int width,
                                   int height) {
    const Environment unturned;
    const auto seen = [&](const PanoramaMark& mark) {
        return direction_from_uv(unturned, mark.pixel / glm::dvec2(width, height));
    };
    const glm::dvec3 a = seen(first), b = seen(second);
    const glm::dvec3 to_a = glm::normalize(first.direction),
                     to_b = glm::normalize(second.direction);
    const double apart = angle_between(a, b), wanted = angle_between(to_a, to_b);
    for (const double angle : {apart, wanted}) {
        if (!(angle >= kLeastApart_rad && angle <= std::numbers::pi - kLeastApart_rad)) {
            throw Refused(fmt::format("the two marks lie {:.1f} degrees apart",
                                      180.0 / std::numbers::pi * angle),
                          "take marks about a right angle apart");
        }
    }
    PanoramaOrientation orientation;
    orientation.residual_rad = std::abs(apart - wanted);
    if (!(orientation.residual_rad <= kLargestResidual_rad)) {
        throw Refused(fmt::format("the marks lie {:.1f} degrees apart in the panorama, and their "
                                  "directions {:.1f}",
                                  180.0 / std::numbers::pi * apart,
                                  180.0 / std::numbers::pi * wanted),
                      "check the marks' pixels and directions");
    }
    orientation.world_from_panorama = frame_of(to_a, to_b) * glm::transpose(frame_of(a, b));
    return orientation;
}

SeeDirection seen_in_panorama(const glm::dmat3& world_from_panorama, int width, int height) {
    const glm::dmat3 panorama_from_world = glm::transpose(world_from_panorama);
    return [=](const glm::dvec3& direction) -> std::optional<SeenAt> {
        static const Environment unturned;
        const glm::dvec2 uv = uv_from_direction(unturned, panorama_from_world * direction);
        SeenAt seen;
        seen.pixel = uv * glm::dvec2(width, height);
        const double down = std::numbers::pi / height,
                     across = 2.0 * std::numbers::pi / width * std::sin(std::numbers::pi * uv.y);
        seen.widest_rad = std::max(down, across);
        // Toward a pole pixels narrow to nothing; no more is told there than across.
        seen.finest_rad = std::max(std::min(down, across), 0.1 * seen.widest_rad);
        return seen;
    };
}

}  // namespace livery
