#include "studio/presenting/surround.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "projection/numerals.h"

namespace livery {

namespace {

constexpr std::uint8_t kGrey = 120;  // readable, and too faint to change what the eye is used to
constexpr double kLargest = 0.26, kSmallest = 0.06;  // of the picture's height
constexpr double kApart = 0.02;

/// Lit pixels left of and above each, so that a rectangle is four look-ups.
std::vector<int> summed(const Image8& lit) {
    const auto width = static_cast<std::size_t>(lit.width) + 1;
    std::vector<int> sums(width * (static_cast<std::size_t>(lit.height) + 1));
    for (std::size_t y = 0; y < static_cast<std::size_t>(lit.height); ++y) {
        int row = 0;
        for (std::size_t x = 0; x + 1 < width; ++x) {
            row += lit.values[y * (width - 1) + x] != 0 ? 1 : 0;
            sums[(y + 1) * width + x + 1] = sums[y * width + x + 1] + row;
        }
    }
    return sums;
}

void fill(Image8& picture, const PixelRectangle& area, std::uint8_t level) {
    for (int y = area.top; y < area.bottom; ++y) {
        std::fill(picture.pixel(area.left, y),
                  picture.pixel(area.left, y) + 3 * (area.right - area.left),
                  level);
    }
}

void put(const Image8& from, int left, int top, Image8& to) {
    for (int y = 0; y < from.height; ++y) {
        std::copy_n(from.pixel(0, y), 3 * from.width, to.pixel(left, top + y));
    }
}

}  // namespace

void add_lit_pixels(const Image8& picture, Image8& lit) {
    if (lit.empty()) lit = Image8(picture.width, picture.height, 1);
    check_argument(lit.width == picture.width && lit.height == picture.height,
                   "lit pixels: found a picture of another size");
    const auto channels = static_cast<std::size_t>(picture.channels);
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        for (std::size_t c = 0; c < channels; ++c) {
            if (picture.values[channels * i + c] != 0) lit.values[i] = 255;
        }
    }
}

std::optional<PixelRectangle> free_place(const Image8& lit, double aspect) {
    const std::vector<int> sums = summed(lit);
    const auto stride = static_cast<std::size_t>(lit.width) + 1;
    const int apart = static_cast<int>(std::lround(kApart * lit.height));
    const auto is_free = [&](const PixelRectangle& place) {
        const auto at = [&](int x, int y) {
            return sums[static_cast<std::size_t>(std::clamp(y, 0, lit.height)) * stride +
                        static_cast<std::size_t>(std::clamp(x, 0, lit.width))];
        };
        const int l = place.left - apart, t = place.top - apart;
        const int r = place.right + apart, b = place.bottom + apart;
        return at(r, b) - at(l, b) - at(r, t) + at(l, t) == 0;
    };
    for (double share = kLargest; share >= kSmallest; share -= 0.01) {
        const int height = static_cast<int>(share * lit.height);
        const int width = static_cast<int>(std::ceil(aspect * height));
        if (width + 2 * apart > lit.width) continue;
        const int right = lit.width - width - apart, bottom = lit.height - height - apart;
        const int middle_x = (lit.width - width) / 2, middle_y = (lit.height - height) / 2;
        const std::pair<int, int> corners[] = {{right, bottom},
                                               {apart, bottom},
                                               {middle_x, bottom},
                                               {right, apart},
                                               {apart, apart},
                                               {middle_x, apart},
                                               {right, middle_y},
                                               {apart, middle_y}};
        for (const auto& [left, top] : corners) {
            const PixelRectangle place{left, top, left + width, top + height};
            if (is_free(place)) return place;
        }
    }
    return std::nullopt;
}

void draw_surround(Image8& picture,
                   const PixelRectangle& place,
                   std::optional<int> number,
                   std::optional<double> fraction) {
    // On a piece of its own, so that nothing reaches beyond the place.
    Image8 piece = crop(picture, place);
    const int bar = std::max(2, piece.height / 12);
    if (number) {
        const double width = number_width_px(*number, 1.0);
        const double height =
            std::min(0.7 * piece.height, 0.94 * piece.width / std::max(width, 1e-6));
        draw_number(
            piece, *number, {0.5 * piece.width, 0.42 * piece.height}, height, glm::u8vec3(kGrey));
    }
    if (fraction) {
        const int length =
            static_cast<int>(std::lround(std::clamp(*fraction, 0.0, 1.0) * piece.width));
        fill(piece, {0, piece.height - bar, length, piece.height}, kGrey);
    }
    put(piece, place.left, place.top, picture);
}

void draw_qr_code(Image8& picture, const PixelRectangle& place, const QrCode& code) {
    const int modules = code.size + 2 * kQrQuietZone;
    const int side = std::min(place.right - place.left, place.bottom - place.top);
    const int scale = side / modules;
    check_argument(scale >= 1,
                   "draw_qr_code: found a place of " + std::to_string(side) + " pixels, expected " +
                       std::to_string(modules) + " or more");
    for (int y = 0; y < modules; ++y) {
        for (int x = 0; x < modules; ++x) {
            if (code.at(x - kQrQuietZone, y - kQrQuietZone)) continue;
            const int left = place.left + x * scale, top = place.top + y * scale;
            fill(picture, {left, top, left + scale, top + scale}, 255);
        }
    }
}

}  // namespace livery
