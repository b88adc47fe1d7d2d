// Pictures whose files tell how they were exposed, as cameras write them.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/pictures/exposure_settings.h"

namespace livery::testing {

inline std::string little_endian(std::uint32_t value, int bytes) {
    std::string text;
    for (int k = 0; k < bytes; ++k) text.push_back(static_cast<char>(value >> (8 * k)));
    return text;
}

struct TiffEntry {
    std::uint32_t tag, type, count;
    std::string value;  ///< four bytes or less in its place, else behind the directory
};

inline TiffEntry tiff_short(std::uint32_t tag, std::uint32_t value) {
    return {tag, 3, 1, little_endian(value, 2)};
}
inline TiffEntry tiff_long(std::uint32_t tag, std::uint32_t value) {
    return {tag, 4, 1, little_endian(value, 4)};
}
/// Times below a second as cameras write them, one over a number.
inline TiffEntry tiff_ratio(std::uint32_t tag, double value) {
    const bool below = value < 0.5;
    const auto number =
        static_cast<std::uint32_t>(std::lround(10.0 * (below ? 1.0 / value : value)));
    return {tag,
            5,
            1,
            below ? little_endian(10, 4) + little_endian(number, 4)
                  : little_endian(number, 4) + little_endian(10, 4)};
}

/// A directory at place `at` of its file, with what its entries need behind it; the entries in the
/// order of their tags.
inline std::string tiff_directory(std::uint32_t at, const std::vector<TiffEntry>& entries) {
    const auto count = static_cast<std::uint32_t>(entries.size());
    std::string text = little_endian(count, 2), behind;
    const std::uint32_t end = at + 2 + 12 * count + 4;
    for (const TiffEntry& entry : entries) {
        std::string value = entry.value;
        if (value.size() > 4) {
            value = little_endian(end + static_cast<std::uint32_t>(behind.size()), 4);
            behind += entry.value;
        }
        value.resize(4);
        text += little_endian(entry.tag, 2) + little_endian(entry.type, 2) +
                little_endian(entry.count, 4) + value;
    }
    return text + std::string(4, '\0') + behind;
}

/// The directory of what is said; its place in the file as above.
inline std::string exif_directory(std::uint32_t at, const ExposureSettings& settings) {
    std::vector<TiffEntry> entries;
    if (settings.time_s > 0.0) entries.push_back(tiff_ratio(33434, settings.time_s));
    if (settings.f_number > 0.0) entries.push_back(tiff_ratio(33437, settings.f_number));
    if (settings.iso > 0.0)
        entries.push_back(tiff_short(34855, static_cast<std::uint32_t>(settings.iso)));
    return tiff_directory(at, entries);
}

/// A JPEG with an EXIF block before everything else.
inline std::string with_exif(const std::string& jpeg, const ExposureSettings& settings) {
    constexpr std::uint32_t kFirst = 8, kSecond = kFirst + 2 + 12 + 4;
    const std::string block =
        std::string("Exif\0\0", 6) + std::string("II*\0", 4) + little_endian(kFirst, 4) +
        tiff_directory(kFirst, {tiff_long(34665, kSecond)}) + exif_directory(kSecond, settings);
    const auto length = static_cast<std::uint32_t>(block.size() + 2);
    return jpeg.substr(0, 2) + "\xff\xe1" + static_cast<char>(length >> 8u) +
           static_cast<char>(length & 255u) + block + jpeg.substr(2);
}

/// A TIFF of 16 bits, RGB, not compressed.
inline std::string tiff_of(const Image16& rgb, const ExposureSettings& settings) {
    const auto width = static_cast<std::uint32_t>(rgb.width),
               height = static_cast<std::uint32_t>(rgb.height);
    constexpr std::uint32_t kFirst = 8;
    // Twice, for what lies behind the directory is known only when it has been made.
    std::string directory, exif;
    std::uint32_t exif_at = 0, data_at = 0;
    for (int round = 0; round < 2; ++round) {
        directory = tiff_directory(
            kFirst,
            {tiff_long(256, width),
             tiff_long(257, height),
             {258, 3, 3, little_endian(16, 2) + little_endian(16, 2) + little_endian(16, 2)},
             tiff_short(259, 1),
             tiff_short(262, 2),
             tiff_long(273, data_at),
             tiff_short(277, 3),
             tiff_long(278, height),
             tiff_long(279, width * height * 6),
             tiff_long(34665, exif_at)});
        exif_at = kFirst + static_cast<std::uint32_t>(directory.size());
        exif = exif_directory(exif_at, settings);
        data_at = exif_at + static_cast<std::uint32_t>(exif.size());
    }
    std::string file = std::string("II*\0", 4) + little_endian(kFirst, 4) + directory + exif;
    for (const std::uint16_t value : rgb.values) file += little_endian(value, 2);
    return file;
}

}  // namespace livery::testing
