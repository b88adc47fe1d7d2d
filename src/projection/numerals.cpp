#include "projection/numerals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "core/error.h"

namespace livery {
namespace {

// A digit is one unit tall, rows down; a stroke is what a round pen of this radius leaves.
constexpr double kPen = 0.07;
constexpr double kGap = 0.11;

using Stroke = std::vector<glm::dvec2>;
using Digit = std::vector<Stroke>;

/// Angles in degrees, 0 to the right and 90 down.
void arc(Stroke& stroke, glm::dvec2 centre, glm::dvec2 radii, double from, double to) {
    constexpr int kPieces = 40;
    for (int i = 0; i <= kPieces; ++i) {
        const double angle = (from + (to - from) * i / kPieces) * std::numbers::pi / 180.0;
        stroke.push_back(centre + radii * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
}

/// A quadratic curve from the stroke's end.
void curve(Stroke& stroke, glm::dvec2 control, glm::dvec2 end) {
    constexpr int kPieces = 24;
    const glm::dvec2 start = stroke.back();
    for (int i = 1; i <= kPieces; ++i) {
        const double t = static_cast<double>(i) / kPieces, s = 1.0 - t;
        stroke.push_back(s * s * start + 2.0 * s * t * control + t * t * end);
    }
}

Digit zero() {
    Stroke s;
    arc(s, {0.31, 0.33}, {0.24, 0.26}, 180.0, 360.0);
    arc(s, {0.31, 0.67}, {0.24, 0.26}, 0.0, 180.0);
    s.push_back(s.front());
    return {s};
}

Digit two() {
    Stroke s;
    arc(s, {0.31, 0.31}, {0.24, 0.24}, 190.0, 398.0);
    s.insert(s.end(), {{0.08, 0.93}, {0.55, 0.93}});
    return {s};
}

Digit three() {
    Stroke s;
    arc(s, {0.29, 0.2725}, {0.22, 0.2025}, 205.0, 450.0);
    arc(s, {0.29, 0.7025}, {0.25, 0.2275}, 270.0, 515.0);
    return {s, {{0.2, 0.475}, {0.29, 0.475}}};
}

Digit five() {
    Stroke s = {{0.51, 0.07}, {0.13, 0.07}, {0.1, 0.47}};
    arc(s, {0.3, 0.65}, {0.25, 0.28}, 219.0, 520.0);
    return {s};
}

Digit six() {
    Stroke bowl, stem = {{0.07, 0.66}};
    arc(bowl, {0.31, 0.66}, {0.24, 0.27}, 0.0, 360.0);
    curve(stem, {0.07, 0.28}, {0.43, 0.07});
    return {bowl, stem};
}

Digit eight() {
    Stroke top, bottom;
    arc(top, {0.31, 0.2725}, {0.205, 0.2025}, 0.0, 360.0);
    arc(bottom, {0.31, 0.7025}, {0.24, 0.2275}, 0.0, 360.0);
    return {top, bottom};
}

Digit nine() {
    Digit turned = six();
    for (auto& stroke : turned) {
        for (auto& point : stroke) point = glm::dvec2(1.0) - point;
    }
    return turned;
}

const Digit& digit(char name) {
    static const std::array<Digit, 10> kDigits = {
        zero(),
        Digit{{{0.13, 0.23}, {0.36, 0.07}, {0.36, 0.93}}},
        two(),
        three(),
        Digit{{{0.43, 0.93}, {0.43, 0.07}, {0.07, 0.7}, {0.56, 0.7}}},
        five(),
        six(),
        Digit{{{0.07, 0.07}, {0.55, 0.07}, {0.21, 0.93}}},
        eight(),
        nine(),
    };
    return kDigits[static_cast<std::size_t>(name - '0')];
}

/// From the left edge of the ink to the right one.
struct NumeralExtent {
    double left = 1e9, right = -1e9;
    double width() const { return right - left; }
};

NumeralExtent extent(const Digit& digit_strokes) {
    NumeralExtent ink;
    for (const auto& stroke : digit_strokes) {
        for (const auto& point : stroke) {
            ink.left = std::min(ink.left, point.x - kPen);
            ink.right = std::max(ink.right, point.x + kPen);
        }
    }
    return ink;
}

double distance_to(const Stroke& stroke, const glm::dvec2& point) {
    double nearest = 1e9;
    for (std::size_t i = 1; i < stroke.size(); ++i) {
        const glm::dvec2 a = stroke[i - 1], along = stroke[i] - a;
        const double length2 = glm::dot(along, along);
        const double t =
            length2 > 0.0 ? std::clamp(glm::dot(point - a, along) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(point - a - t * along));
    }
    return nearest;
}

}  // namespace

double number_width_px(int number, double height_px) {
    check_argument(number >= 0, "a number to draw is negative: " + std::to_string(number));
    double width = -kGap;
    for (const char name : std::to_string(number)) width += extent(digit(name)).width() + kGap;
    return height_px * width;
}

void draw_number(Image8& picture,
                 int number,
                 glm::dvec2 centre_px,
                 double height_px,
                 const glm::u8vec3& colour) {
    check_argument(picture.channels == 3, "a number needs a picture of three channels");
    const glm::dvec2 corner =
        centre_px - 0.5 * glm::dvec2(number_width_px(number, height_px), height_px);
    double left = 0.0;
    for (const char name : std::to_string(number)) {
        const NumeralExtent ink = extent(digit(name));
        const glm::dvec2 from = corner + height_px * glm::dvec2(left, 0.0);
        const glm::dvec2 to = from + height_px * glm::dvec2(ink.width(), 1.0);
        left += ink.width() + kGap;
        const int x_end = std::min(picture.width, static_cast<int>(std::ceil(to.x)) + 1);
        const int y_end = std::min(picture.height, static_cast<int>(std::ceil(to.y)) + 1);
        for (int y = std::max(0, static_cast<int>(from.y) - 1); y < y_end; ++y) {
            for (int x = std::max(0, static_cast<int>(from.x) - 1); x < x_end; ++x) {
                const glm::dvec2 point =
                    (glm::dvec2(x + 0.5, y + 0.5) - from) / height_px + glm::dvec2(ink.left, 0.0);
                double nearest = 1e9;
                for (const auto& stroke : digit(name)) {
                    nearest = std::min(nearest, distance_to(stroke, point));
                }
                const double cover = std::clamp((kPen - nearest) * height_px + 0.5, 0.0, 1.0);
                auto* pixel = picture.pixel(x, y);
                for (int c = 0; c < 3; ++c) {
                    pixel[c] = static_cast<std::uint8_t>(
                        std::lround(pixel[c] + cover * (colour[c] - pixel[c])));
                }
            }
        }
    }
}

}  // namespace livery
