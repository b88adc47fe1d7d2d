#include "core/pictures/png_damage.h"

#include <cstdint>
#include <vector>

#include <zlib.h>

#include "core/utf8.h"

namespace livery {

namespace {

std::uint32_t big_endian(const char* bytes) {
    std::uint32_t value = 0;
    for (int k = 0; k < 4; ++k) value = value << 8u | static_cast<unsigned char>(bytes[k]);
    return value;
}

}  // namespace

std::string png_damage(std::istream& stream) {
    stream.seekg(0, std::ios::end);
    const auto file_bytes = static_cast<std::uint64_t>(stream.tellg());
    std::uint64_t at = 8;
    std::vector<char> chunk;
    std::string name;
    while (name != "IEND") {
        char length_bytes[4];
        stream.seekg(static_cast<std::streamoff>(at));
        if (at + 12 > file_bytes || !stream.read(length_bytes, 4)) return "a cut-off PNG";
        const std::uint64_t length = big_endian(length_bytes);
        if (at + 12 + length > file_bytes) return "a cut-off PNG";
        chunk.resize(length + 8);
        if (!stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()))) {
            return "a PNG that cannot be read";
        }
        name.assign(chunk.data(), 4);
        const auto sum =
            ::crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(length + 4));
        if (sum != big_endian(chunk.data() + length + 4)) {
            return "a PNG damaged at byte " + std::to_string(at) + " (" + printable(name) + ")";
        }
        if (at == 8 && (name != "IHDR" || length != 13)) return "a PNG without a header";
        if (at == 8) {
            const auto width = big_endian(chunk.data() + 4), height = big_endian(chunk.data() + 8);
            constexpr std::uint32_t max_side = 1'000'000;  // libpng's own limit
            if (width == 0 || height == 0 || width > max_side || height > max_side) {
                return "a PNG of " + std::to_string(width) + "x" + std::to_string(height) +
                       " pixels";
            }
        }
        at += 12 + length;
    }
    return "";
}

}  // namespace livery
