#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include <xcb/shape.h>

#include "projection/numerals.h"
#include "projection/projector_screen.h"
#include "projection/stacking.h"
#include "projection/x_connection.h"

namespace livery {
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

}  // namespace livery
