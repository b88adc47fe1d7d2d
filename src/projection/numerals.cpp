#include "projection/numerals.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <xcb/shape.h>

#include "core/error.h"
#include "projection/monitors.h"
#include "projection/outputs.h"
#include "projection/projector_screen.h"

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

namespace {

constexpr int kDigitHeight_px = 300;
constexpr double kMargin = 0.36, kCorner = 0.2;  // of the digits' height
constexpr glm::u8vec3 kTile{24, 26, 30}, kInk{255, 255, 255};

Image8 tile_picture(int number, int digit_px) {
    const int margin = static_cast<int>(std::lround(kMargin * digit_px));
    const int height = digit_px + 2 * margin;
    const int width = std::max(
        height, static_cast<int>(std::ceil(number_width_px(number, digit_px))) + 2 * margin);
    Image8 picture(width, height, 3);
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        picture.values[i] = kTile[static_cast<int>(i % 3)];
    }
    draw_number(picture, number, {width * 0.5, height * 0.5}, digit_px, kInk);
    return picture;
}

/// The rows of a rectangle with round corners.
std::vector<xcb_rectangle_t> rounded(int width, int height, double radius) {
    std::vector<xcb_rectangle_t> rows;
    for (int y = 0; y < height; ++y) {
        const double from_edge = std::min(y + 0.5, height - y - 0.5);
        const double up = std::max(0.0, radius - from_edge);
        const int inset =
            static_cast<int>(std::lround(radius - std::sqrt(radius * radius - up * up)));
        rows.push_back({static_cast<std::int16_t>(inset),
                        static_cast<std::int16_t>(y),
                        static_cast<std::uint16_t>(width - 2 * inset),
                        1});
    }
    return rows;
}

const xcb_visualtype_t& root_visual(const XConnection& x) {
    for (auto depth = xcb_screen_allowed_depths_iterator(&x.screen()); depth.rem != 0;
         xcb_depth_next(&depth)) {
        for (auto visual = xcb_depth_visuals_iterator(depth.data); visual.rem != 0;
             xcb_visualtype_next(&visual)) {
            if (visual.data->visual_id == x.screen().root_visual) return *visual.data;
        }
    }
    throw std::runtime_error("the X server does not describe its own screen");
}

/// A channel's bits in a pixel of the screen.
std::uint32_t packed(std::uint8_t value, std::uint32_t mask) {
    const auto most = mask >> std::countr_zero(mask);
    return static_cast<std::uint32_t>((std::uint64_t{value} * most + 127u) / 255u)
           << std::countr_zero(mask);
}

xcb_pixmap_t upload(const XConnection& x, const Image8& picture) {
    auto* c = x.get();
    const auto& visual = root_visual(x);
    std::vector<std::uint32_t> pixels;
    pixels.reserve(picture.pixel_count());
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        const auto* rgb = picture.values.data() + 3 * i;
        pixels.push_back(packed(rgb[0], visual.red_mask) | packed(rgb[1], visual.green_mask) |
                         packed(rgb[2], visual.blue_mask));
    }
    const auto width = static_cast<std::uint16_t>(picture.width);
    const auto height = static_cast<std::uint16_t>(picture.height);
    const xcb_pixmap_t pixmap = xcb_generate_id(c);
    const xcb_gcontext_t context = xcb_generate_id(c);
    xcb_create_pixmap(c, x.screen().root_depth, pixmap, x.root(), width, height);
    xcb_create_gc(c, context, pixmap, 0, nullptr);
    for (int y = 0; y < picture.height; ++y) {  // a row always fits into a request
        xcb_put_image(c,
                      XCB_IMAGE_FORMAT_Z_PIXMAP,
                      pixmap,
                      context,
                      width,
                      1,
                      0,
                      static_cast<std::int16_t>(y),
                      0,
                      x.screen().root_depth,
                      4u * width,
                      reinterpret_cast<const std::uint8_t*>(pixels.data() +
                                                            static_cast<std::size_t>(y) * width));
    }
    xcb_free_gc(c, context);
    return pixmap;
}

/// The server paints the background by itself whenever the window is uncovered: nothing here has to
/// run while the numbers are shown.
void show_tile(const XConnection& x, const Monitor& monitor) {
    auto* c = x.get();
    const int digit_px = std::min(kDigitHeight_px, monitor.height * 2 / 5);
    const Image8 picture = tile_picture(monitor.number, digit_px);
    const xcb_pixmap_t pixmap = upload(x, picture);
    const xcb_window_t window = xcb_generate_id(c);
    const std::array<std::uint32_t, 2> values = {pixmap, 1};
    xcb_create_window(c,
                      XCB_COPY_FROM_PARENT,
                      window,
                      x.root(),
                      static_cast<std::int16_t>(monitor.x + (monitor.width - picture.width) / 2),
                      static_cast<std::int16_t>(monitor.y + (monitor.height - picture.height) / 2),
                      static_cast<std::uint16_t>(picture.width),
                      static_cast<std::uint16_t>(picture.height),
                      0,
                      XCB_WINDOW_CLASS_INPUT_OUTPUT,
                      XCB_COPY_FROM_PARENT,
                      XCB_CW_BACK_PIXMAP | XCB_CW_OVERRIDE_REDIRECT,
                      values.data());
    xcb_free_pixmap(c, pixmap);
    mark_as_overlay(x, window);
    if (x.has(xcb_shape_id)) {
        const auto rows = rounded(picture.width, picture.height, kCorner * digit_px);
        xcb_shape_rectangles(c,
                             XCB_SHAPE_SO_SET,
                             XCB_SHAPE_SK_BOUNDING,
                             XCB_CLIP_ORDERING_UNSORTED,
                             window,
                             0,
                             0,
                             static_cast<std::uint32_t>(rows.size()),
                             rows.data());
        // The pointer goes through.
        xcb_shape_rectangles(c,
                             XCB_SHAPE_SO_SET,
                             XCB_SHAPE_SK_INPUT,
                             XCB_CLIP_ORDERING_UNSORTED,
                             window,
                             0,
                             0,
                             0,
                             nullptr);
    }
    xcb_map_window(c, window);
}

}  // namespace

struct MonitorNumbers::Implementation {
    XConnection x;  ///< its end takes the windows along
};

MonitorNumbers::MonitorNumbers(const std::vector<Monitor>& monitors)
    : implementation_(std::make_unique<Implementation>()) {
    for (const auto& monitor : monitors) show_tile(implementation_->x, monitor);
    implementation_->x.synchronise();
}

MonitorNumbers::~MonitorNumbers() = default;

namespace {

// Limited range ends at 16 and 235: what lies beyond merges with black or white when a projector
// takes full levels for limited ones.
constexpr std::array<std::uint8_t, 7> kDark = {0, 4, 8, 12, 16, 20, 24};
constexpr std::array<std::uint8_t, 7> kBright = {255, 251, 247, 243, 239, 235, 231};
constexpr int kLabelDistance = 48;  // readable, and too faint to blind the eye

void fill(Image8& picture, int x0, int y0, int x1, int y1, std::uint8_t level) {
    for (int y = std::max(0, y0); y < std::min(picture.height, y1); ++y) {
        std::fill(picture.pixel(0, y) + 3 * x0, picture.pixel(0, y) + 3 * x1, level);
    }
}

/// One row of patches on the row's first level, each with its level above it.
void draw_row(Image8& picture, int top, int bottom, const std::array<std::uint8_t, 7>& levels) {
    const int height = bottom - top;
    const int label_px = height / 12;
    const auto label =
        static_cast<std::uint8_t>(levels.front() == 0 ? kLabelDistance : 255 - kLabelDistance);
    // What is left of this is the line around the picture, which overscan cuts off.
    fill(picture, 0, top, picture.width, bottom, label);
    fill(picture,
         1,
         std::max(top, 1),
         picture.width - 1,
         std::min(bottom, picture.height - 1),
         levels.front());
    const int count = static_cast<int>(levels.size());
    for (int i = 0; i < count; ++i) {
        const auto level = levels[static_cast<std::size_t>(i)];
        const int gap = picture.width / (count * 8);
        const int x0 = picture.width * i / count + gap;
        const int x1 = picture.width * (i + 1) / count - gap;
        fill(picture, x0, top + height * 3 / 10, x1, bottom - height / 10, level);
        draw_number(
            picture, level, {0.5 * (x0 + x1), top + 0.18 * height}, label_px, glm::u8vec3(label));
    }
}

}  // namespace

Image8 signal_test_picture(int width, int height) {
    check_argument(width >= 64 && height >= 64,
                   "a signal test picture of " + std::to_string(width) + "x" +
                       std::to_string(height) + " pixels; at least 64x64");
    Image8 picture(width, height, 3);
    draw_row(picture, 0, height / 2, kDark);
    draw_row(picture, height / 2, height, kBright);
    return picture;
}

}  // namespace livery
