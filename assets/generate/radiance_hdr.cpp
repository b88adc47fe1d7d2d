#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "environments.h"

namespace livery::assets {

namespace {

using Rgbe = std::array<unsigned char, 4>;

/// Ward's shared exponent with rounding to nearest (plain truncation would darken by 0.2%).
Rgbe encode(const float* rgb) {
    const float largest = std::max({rgb[0], rgb[1], rgb[2]});
    if (!(largest > 1e-32f)) return {0, 0, 0, 0};
    int exponent = 0;
    std::frexp(largest, &exponent);
    if (std::lround(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
    Rgbe pixel{};
    for (std::size_t k = 0; k < 3; ++k) {
        pixel[k] = static_cast<unsigned char>(std::lround(std::ldexp(rgb[k], 8 - exponent)));
    }
    pixel[3] = static_cast<unsigned char>(exponent + 128);
    return pixel;
}

/// One channel of a scanline: runs of at least four equal bytes, the rest as literals.
void append_channel(std::string& bytes, const std::vector<unsigned char>& line) {
    constexpr std::size_t kShortestRun = 4, kLongestRun = 127, kLongestLiteral = 128;
    std::size_t k = 0;
    const auto run_at = [&](std::size_t from) {
        std::size_t n = 1;
        while (from + n < line.size() && n < kLongestRun && line[from + n] == line[from]) ++n;
        return n;
    };
    while (k < line.size()) {
        const std::size_t run = run_at(k);
        if (run >= kShortestRun) {
            bytes += static_cast<char>(128 + run);
            bytes += static_cast<char>(line[k]);
            k += run;
            continue;
        }
        std::size_t end = k;
        while (end < line.size() && end - k < kLongestLiteral && run_at(end) < kShortestRun) ++end;
        bytes += static_cast<char>(end - k);
        for (; k < end; ++k) bytes += static_cast<char>(line[k]);
    }
}

}  // namespace

std::string hdr_bytes(const ImageF& image) {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) +
                        " +X " + std::to_string(image.width) + "\n";
    std::vector<unsigned char> line(static_cast<std::size_t>(image.width));
    for (int row = 0; row < image.height; ++row) {
        bytes += {2, 2, static_cast<char>(image.width >> 8), static_cast<char>(image.width & 255)};
        for (std::size_t channel = 0; channel < 4; ++channel) {
            for (int column = 0; column < image.width; ++column) {
                line[static_cast<std::size_t>(column)] = encode(image.pixel(column, row))[channel];
            }
            append_channel(bytes, line);
        }
    }
    return bytes;
}

}  // namespace livery::assets
