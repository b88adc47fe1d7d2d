#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "projection/monitors.h"
#include "projection/numerals.h"

namespace livery {
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
