// RAW files as cameras write them: what is in them is known exactly.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "core/bench_ports.h"
#include "support/exif.h"

namespace livery::testing {

/// What the sensor's pixel has behind a Bayer filter R G / G B.
inline std::uint16_t bayer(
    int x, int y, std::uint16_t red, std::uint16_t green, std::uint16_t blue) {
    return x % 2 != y % 2 ? green : x % 2 == 1 ? blue : red;
}

/// A DNG (a TIFF with a colour filter array R G / G B, 16 bit, white at 65535) of so many of the
/// sensor's pixels, that asks for a white balance of 2, 1, 1.43, exposed as it says.
inline std::string dng_of(int width,
                          int height,
                          std::uint32_t black,
                          const std::function<std::uint16_t(int x, int y)>& sample,
                          const ExposureSettings& said = {}) {
    const std::uint32_t entry_count = said == ExposureSettings{} ? 24 : 25;
    const auto columns = static_cast<std::uint32_t>(width),
               rows = static_cast<std::uint32_t>(height);
    const std::uint32_t data_at = 8 + 2 + 12 * entry_count + 4;
    std::vector<std::tuple<std::uint32_t, std::string>> entries;  // tag, the entry's 12 bytes
    std::string data;
    const auto add = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t n, std::string raw) {
        std::string value = raw;
        if (raw.size() > 4) {
            value = little_endian(data_at + static_cast<std::uint32_t>(data.size()), 4);
            data += raw;
        }
        value.resize(4);
        entries.emplace_back(
            tag, little_endian(tag, 2) + little_endian(type, 2) + little_endian(n, 4) + value);
    };
    const auto shorts = [&](std::uint32_t tag, std::uint32_t value) {
        add(tag, 3, 1, little_endian(value, 2));
    };
    const auto longs = [&](std::uint32_t tag, std::uint32_t value) {
        add(tag, 4, 1, little_endian(value, 4));
    };
    const auto ratios = [&](std::uint32_t tag, std::uint32_t type, std::vector<double> values) {
        std::string raw;
        for (const double value : values) {
            raw += little_endian(static_cast<std::uint32_t>(value * 1e4), 4) +
                   little_endian(10'000, 4);
        }
        add(tag, type, static_cast<std::uint32_t>(values.size()), raw);
    };
    longs(254, 0);
    longs(256, columns);
    longs(257, rows);
    shorts(258, 16);
    shorts(259, 1);      // not compressed
    shorts(262, 32803);  // colour filter array
    add(271, 2, 6, std::string("Maker\0", 6));
    add(272, 2, 6, std::string("Model\0", 6));
    shorts(274, 1);
    shorts(277, 1);
    longs(278, rows);
    longs(279, columns * rows * 2);
    shorts(284, 1);
    add(33421, 3, 2, little_endian(2, 2) + little_endian(2, 2));
    add(33422, 1, 4, std::string("\0\1\1\2", 4));
    add(50706, 1, 4, std::string("\1\4\0\0", 4));
    add(50708, 2, 12, std::string("Maker Model\0", 12));
    longs(50714, black);
    longs(50717, 65535);
    if (said != ExposureSettings{}) {
        const auto at = data_at + static_cast<std::uint32_t>(data.size());
        longs(34665, at);
        data += exif_directory(at, said);
    }
    ratios(50721, 10, {1, 0, 0, 0, 1, 0, 0, 0, 1});
    ratios(50728, 5, {0.5, 1.0, 0.7});
    shorts(50778, 21);
    longs(50730, 0);
    longs(273, data_at + static_cast<std::uint32_t>(data.size()));
    std::sort(entries.begin(), entries.end());

    std::string file = std::string("II*\0", 4) + little_endian(8, 4) +
                       little_endian(static_cast<std::uint32_t>(entries.size()), 2);
    for (const auto& [tag, entry] : entries) file += entry;
    file.resize(data_at);
    file += data;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) file += little_endian(sample(x, y), 2);
    return file;
}

/// What the simulated bench's camera saw, each of its pixels as a square of a sensor's colour
/// filter with four times the values.
inline std::string dng_of(const Photograph& seen) {
    const auto sample = [&](int x, int y) {
        const int channel = x % 2 != y % 2 ? 1 : x % 2 == 1 ? 2 : 0;
        return static_cast<std::uint16_t>(4.0f * seen.image.at(x / 2, y / 2, channel));
    };
    return dng_of(2 * seen.image.width,
                  2 * seen.image.height,
                  static_cast<std::uint32_t>(4.0 * seen.black_level),
                  sample);
}

}  // namespace livery::testing
