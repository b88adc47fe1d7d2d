// A picture as a plain value.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace livery {

/// Interleaved pixels, rows go down, pixel centres at half integers (pixel (0,0) covers
/// [0,1)x[0,1)).
template <typename T>
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<T> values;  ///< height x width x channels

    Image() = default;
    Image(int width_px, int height_px, int channel_count, T fill = T{})
        : width(width_px),
          height(height_px),
          channels(channel_count),
          values(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) *
                     static_cast<std::size_t>(channel_count),
                 fill) {}

    bool empty() const { return values.empty(); }
    std::size_t pixel_count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    std::size_t index(int x, int y, int c = 0) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels) +
               static_cast<std::size_t>(c);
    }
    T& at(int x, int y, int c = 0) { return values[index(x, y, c)]; }
    const T& at(int x, int y, int c = 0) const { return values[index(x, y, c)]; }
    T* pixel(int x, int y) { return values.data() + index(x, y); }
    const T* pixel(int x, int y) const { return values.data() + index(x, y); }
};

using ImageF = Image<float>;
using Image8 = Image<std::uint8_t>;
using Image16 = Image<std::uint16_t>;

/// A rectangle of pixels, [left, right) x [top, bottom).
struct PixelRectangle {
    int left = 0, top = 0, right = 0, bottom = 0;
};

/// The rectangle must lie inside the picture.
template <typename T>
Image<T> crop(const Image<T>& image, const PixelRectangle& rectangle) {
    Image<T> result(
        rectangle.right - rectangle.left, rectangle.bottom - rectangle.top, image.channels);
    for (int y = 0; y < result.height; ++y) {
        const T* from = image.pixel(rectangle.left, rectangle.top + y);
        std::copy(from,
                  from + static_cast<std::ptrdiff_t>(result.width) * image.channels,
                  result.pixel(0, y));
    }
    return result;
}

}  // namespace livery
