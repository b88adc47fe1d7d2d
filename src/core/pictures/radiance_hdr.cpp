#include "core/pictures/radiance_hdr.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <vector>

namespace livery {
namespace {

std::optional<std::string_view> take_line(std::string_view& bytes) {
    const auto end = bytes.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const auto line = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    return line;
}

std::optional<int> take_number(std::string_view& text) {
    int number = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    if (result.ec != std::errc() || number <= 0) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
    return number;
}

bool take(std::string_view& text, std::string_view expected) {
    if (!text.starts_with(expected)) return false;
    text.remove_prefix(expected.size());
    return true;
}

struct Size {
    int width = 0, height = 0;
};

/// Past the header; only rows downward, columns to the right.
std::optional<Size> take_header(std::string_view& bytes) {
    auto line = take_line(bytes);
    if (!line || (*line != "#?RADIANCE" && *line != "#?RGBE")) return std::nullopt;
    bool known_format = false;
    while ((line = take_line(bytes)) && !line->empty()) {
        if (*line == "FORMAT=32-bit_rle_rgbe") known_format = true;
    }
    if (!line || !known_format) return std::nullopt;
    line = take_line(bytes);
    if (!line || !take(*line, "-Y ")) return std::nullopt;
    const auto height = take_number(*line);
    if (!height || !take(*line, " +X ")) return std::nullopt;
    const auto width = take_number(*line);
    if (!width || !line->empty()) return std::nullopt;
    return Size{*width, *height};
}

/// One row's four channels, one after the other; false when the bytes are of another kind.
bool take_row(std::string_view& bytes, std::vector<std::uint8_t>& row) {
    const std::size_t width = row.size() / 4;
    const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(bytes[k]); };
    if (bytes.size() < 4 || byte(0) != 2 || byte(1) != 2) return false;
    if (static_cast<std::size_t>(byte(2)) * 256 + byte(3) != width) return false;
    bytes.remove_prefix(4);
    for (std::size_t channel = 0; channel < 4; ++channel) {
        std::size_t at = channel * width;
        const std::size_t end = at + width;
        while (at < end) {
            if (bytes.size() < 2) return false;
            const bool run = byte(0) > 128;
            const std::size_t count = run ? byte(0) - 128u : byte(0);
            const std::size_t coded = run ? 1 : count;
            if (count == 0 || count > end - at || bytes.size() < 1 + coded) return false;
            for (std::size_t k = 0; k < count; ++k) row[at++] = byte(run ? 1 : 1 + k);
            bytes.remove_prefix(1 + coded);
        }
    }
    return true;
}

}  // namespace

std::optional<ImageF> decode_radiance_hdr(std::string_view bytes, std::size_t max_pixels) {
    const auto size = take_header(bytes);
    // Widths that the run lengths cannot code, and a row of which takes more bytes than there are
    constexpr int kNarrowest = 8, kWidest = 32767;
    if (!size || size->width < kNarrowest || size->width > kWidest) return std::nullopt;
    const auto width = static_cast<std::size_t>(size->width);
    const auto height = static_cast<std::size_t>(size->height);
    const std::size_t shortest_row = 4 + 8 * ((width + 126) / 127);
    if (width * height > max_pixels || height > bytes.size() / shortest_row) return std::nullopt;

    std::array<float, 256> scale{};
    for (std::size_t e = 1; e < scale.size(); ++e) {
        scale[e] = std::ldexp(1.0f, static_cast<int>(e) - (128 + 8));
    }
    ImageF picture(size->width, size->height, 3);
    std::vector<std::uint8_t> row(4 * width);
    for (int y = 0; y < size->height; ++y) {
        if (!take_row(bytes, row)) return std::nullopt;
        float* to = picture.pixel(0, y);
        for (std::size_t x = 0; x < width; ++x) {
            const float s = scale[row[3 * width + x]];
            for (std::size_t c = 0; c < 3; ++c) *to++ = s * static_cast<float>(row[c * width + x]);
        }
    }
    return picture;
}

}  // namespace livery
