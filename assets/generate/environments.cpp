#include "environments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace livery::assets {

namespace {

/// A soft-edged rectangular light seen from the origin: `axis` unit toward its centre, `right` and
/// `up` unit in its plane. Sizes are for a plane at distance 1.
struct Softbox {
    glm::dvec3 axis, right, up;
    double half_width, half_height;
    double edge;  ///< half of the soft edge's width above and below
    glm::dvec3 radiance;
};

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

glm::dvec3 light_of(const Softbox& box, const glm::dvec3& direction) {
    const double along = glm::dot(direction, box.axis);
    if (along <= 1e-6) return glm::dvec3(0.0);
    const double x = std::abs(glm::dot(direction, box.right)) / along;
    const double y = std::abs(glm::dot(direction, box.up)) / along;
    const auto side = [](double at, double half, double edge) {
        return 1.0 - smooth_step(half - edge, half + edge, at);
    };
    // At the ends, seen at a slant, the soft edge takes the same angle or more.
    const double end_edge = 1.5 * box.edge * (1.0 + box.half_width * box.half_width);
    // The lamp behind the cloth makes the middle a little brighter than the rim.
    const double u = x / box.half_width, v = y / box.half_height;
    const double falloff = 1.0 - 0.18 * std::min(1.0, 0.5 * (u * u + v * v));
    return box.radiance *
           (side(x, box.half_width, end_edge) * side(y, box.half_height, box.edge) * falloff);
}

Softbox softbox(const glm::dvec3& toward,
                const glm::dvec3& right,
                double half_width,
                double half_height,
                double edge,
                const glm::dvec3& radiance) {
    const auto axis = glm::normalize(toward);
    const auto across = glm::normalize(right - axis * glm::dot(right, axis));
    return {axis, across, glm::cross(axis, across), half_width, half_height, edge, radiance};
}

}  // namespace

glm::dvec3 studio_radiance(const glm::dvec3& direction) {
    static const Softbox boxes[]{
        // Overhead, along the car.
        softbox({0.0, 1.0, 0.0}, {1, 0, 0}, 0.66, 0.17, 0.05, glm::dvec3(4.6, 4.6, 4.6)),
        // Strips along both sides, the left one larger and a little warm: the key.
        softbox({0.0, 0.25, 1.0}, {1, 0, 0}, 1.90, 0.070, 0.042, glm::dvec3(5.3, 5.15, 4.95)),
        softbox({0.0, 0.23, -1.0}, {1, 0, 0}, 1.90, 0.050, 0.035, glm::dvec3(4.1, 4.3, 4.6)),
        // The rim light, high behind the tail.
        softbox({-1.0, 0.55, -0.15}, {0, 0, 1}, 0.26, 0.08, 0.05, glm::dvec3(7.2, 7.3, 7.6)),
    };
    // The room: dark walls a little lighter toward the ceiling, a light floor that falls off with
    // distance, without a kink at the horizon.
    const double wall = 0.075 + 0.03 * std::max(direction.y, 0.0);
    const double floor = 0.10 + 0.22 * smooth_step(0.0, 0.9, -direction.y);
    const double floor_share = smooth_step(0.03, -0.10, direction.y);
    glm::dvec3 radiance(glm::mix(wall, floor, floor_share));
    for (const auto& box : boxes) radiance += light_of(box, direction);
    return radiance;
}

glm::dvec3 overcast_radiance(const glm::dvec3& direction) {
    // Moon and Spencer (1942): L = Lz (1 + 2 sin h) / 3, whose irradiance on level ground is
    // 7 pi Lz / 9.
    constexpr double kZenith = 9.0 / 7.0, kGroundReflectance = 0.2;
    if (direction.y < 0.0) return glm::dvec3(kGroundReflectance);
    return glm::dvec3(kZenith * (1.0 + 2.0 * direction.y) / 3.0);
}

ImageF environment_map(glm::dvec3 (*radiance)(const glm::dvec3&), int width) {
    constexpr double kPi = std::numbers::pi;
    constexpr int kSamples = 4;
    const int height = width / 2;
    ImageF map(width, height, 3);
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            glm::dvec3 sum(0.0);
            for (int s = 0; s < kSamples * kSamples; ++s) {
                const double u = (column + (s % kSamples + 0.5) / kSamples) / width;
                const double v = (row + (s / kSamples + 0.5) / kSamples) / height;
                const double polar = kPi * v, azimuth = 2.0 * kPi * (u - 0.5);
                sum += radiance({std::sin(polar) * std::sin(azimuth),
                                 std::cos(polar),
                                 -std::sin(polar) * std::cos(azimuth)});
            }
            for (int c = 0; c < 3; ++c) {
                map.at(column, row, c) = static_cast<float>(sum[c] / (kSamples * kSamples));
            }
        }
    }
    return map;
}

EnvironmentAverages averages(const ImageF& map) {
    constexpr double kPi = std::numbers::pi;
    EnvironmentAverages sum;
    for (int row = 0; row < map.height; ++row) {
        const double above = std::cos(kPi * row / map.height);
        const double below = std::cos(kPi * (row + 1) / map.height);
        double luminance = 0.0;
        for (int column = 0; column < map.width; ++column) {
            const float* rgb = map.pixel(column, row);
            luminance += (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) / map.width;
        }
        // Integrals of 1 / (4 pi) and of the cosine / pi over the row's band of directions.
        sum.mean_radiance += luminance * 0.5 * (above - below);
        const double upper = std::max(above, 0.0), lower = std::max(below, 0.0);
        sum.level_white += luminance * (upper * upper - lower * lower);
    }
    return sum;
}

}  // namespace livery::assets
