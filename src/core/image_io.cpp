#include "core/image_io.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/image.h"
#include "core/paths.h"
#include "core/pictures/exposure_settings.h"
#include "core/pictures/image_io_module.h"
#include "core/pictures/png_bytes.h"
#include "core/system/module.h"

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

/// R, G, B of a whole file's bytes: 32-bit_rle_rgbe, rows downward, run lengths as every writer of
/// the last decades codes them. Nothing for any other file, damaged ones among them: whoever asks
/// has a slower reader that says what is wrong.
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

constexpr const char* kModuleName = "livery_image_io.so";
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 30u;
/// Of one picture, over its channels; below a gigabyte as floats.
constexpr std::uintmax_t kMaxValues = 240'000'000;
/// As many are taken on a file's word. More must be there in its bytes, of which none holds more
/// than deflate packs into it.
constexpr std::uintmax_t kBelievedValues = 64'000'000, kMostValuesPerByte = 1'032;
constexpr const char* kReadable = "a complete EXR, HDR, PNG, TIFF, JPEG or RAW picture";

const ImageIoTable& module_table() {
    static const ImageIoTable& table = *reinterpret_cast<const ImageIoTable* (*)()>(
        symbol_of_module(kModuleName, kImageIoTableSymbol, "Livery's picture reader"))();
    return table;
}

/// Of the file's suffix in any case.
bool has_suffix_among(const std::filesystem::path& file,
                      std::span<const std::string_view> suffixes) {
    std::string suffix = file.extension().string();
    for (char& letter : suffix) {
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    }
    return std::find(suffixes.begin(), suffixes.end(), suffix) != suffixes.end();
}

/// OpenImageIO's name of the format by content, or by extension for the many kinds of RAW; only
/// these readers are ever tried on a file.
const char* format_of(const std::filesystem::path& file, std::string_view start) {
    if (is_raw_suffix(file)) return "raw";
    using namespace std::string_view_literals;
    static constexpr std::pair<std::string_view, const char*> signatures[] = {
        {"\x76\x2f\x31\x01"sv, "openexr"},
        {"\x89PNG\r\n\x1a\n"sv, "png"},
        {"#?RADIANCE"sv, "hdr"},
        {"#?RGBE"sv, "hdr"},
        {"II*\0"sv, "tiff"},
        {"MM\0*"sv, "tiff"},
        {"\xff\xd8\xff"sv, "jpeg"},
    };
    for (const auto& [signature, format] : signatures) {
        if (start.starts_with(signature)) return format;
    }
    return nullptr;
}

std::string start_of(const std::filesystem::path& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) throw FileError(file, "", "no such file", kReadable);
    if (std::filesystem::is_directory(status)) throw FileError(file, "", "a folder", kReadable);
    if (!std::filesystem::is_regular_file(status)) {
        throw FileError(file, "", "a pipe or a device", kReadable);
    }
    if (const auto bytes = std::filesystem::file_size(file, error); !error && bytes > kMaxBytes) {
        throw FileError(file,
                        "",
                        std::to_string(bytes) + " bytes",
                        "at most " + std::to_string(kMaxBytes) + " in a picture");
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw FileError(file, "", std::strerror(errno), "a readable file");
    std::string start(16, '\0');
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(stream.gcount()));
    if (start.empty()) throw FileError(file, "", "an empty file", kReadable);
    return start;
}

/// Refuses sizes that no honest file of this length declares, before anything is allocated.
void check_size(const std::filesystem::path& file,
                std::uintmax_t file_bytes,
                const PictureHeader& header,
                std::size_t max_pixels) {
    const auto size_text = std::to_string(header.width) + "x" + std::to_string(header.height) +
                           " pixels of " + std::to_string(header.channels) + " channels";
    if (header.width <= 0 || header.height <= 0 || header.channels <= 0) {
        throw FileError(file, "size", size_text, "at least 1x1 pixels of 1 channel");
    }
    const auto pixels =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
    const auto channels = static_cast<std::size_t>(header.channels);
    constexpr std::size_t max_channels = 1024;
    if (pixels > max_pixels || channels > max_channels || pixels * channels > kMaxValues) {
        throw FileError(file,
                        "size",
                        size_text,
                        "at most " + std::to_string(max_pixels) + " pixels of " +
                            std::to_string(max_channels) + " channels and " +
                            std::to_string(kMaxValues) + " values in all");
    }
    if (pixels * channels > kBelievedValues &&
        pixels * channels / kMostValuesPerByte > file_bytes) {
        throw FileError(file,
                        "size",
                        size_text + " in " + std::to_string(file_bytes) + " bytes",
                        "a size that fits the file's length");
    }
}

struct ClosePicture {
    void operator()(void* picture) const { module_table().close(picture); }
};

/// The bytes of a picture file; `file` stands in messages.
template <typename T>
std::string encoded(const std::filesystem::path& file,
                    const char* format,
                    const Image<T>& image,
                    int integer_bits,
                    const std::vector<std::string>& channel_names) {
    check_argument(
        image.width > 0 && image.height > 0 && image.channels > 0 &&
            image.values.size() == image.pixel_count() * static_cast<std::size_t>(image.channels),
        "write_image: an image of " + std::to_string(image.width) + "x" +
            std::to_string(image.height) + "x" + std::to_string(image.channels) + " with " +
            std::to_string(image.values.size()) + " values");
    std::vector<const char*> names;
    for (const auto& name : channel_names) names.push_back(name.c_str());
    std::string bytes;
    PictureError error;
    const bool done = module_table().encode(
        format,
        {image.width, image.height, image.channels, integer_bits, {}},
        image.values.data(),
        names.empty() ? nullptr : names.data(),
        [](void* context, const void* data, std::size_t size) {
            static_cast<std::string*>(context)->assign(static_cast<const char*>(data), size);
        },
        &bytes,
        &error);
    if (!done) throw FileError(file, "", error.text, "a picture that can be encoded");
    return bytes;
}

template <typename T>
void write_image(const std::filesystem::path& file,
                 const char* format,
                 const Image<T>& image,
                 int integer_bits,
                 const std::vector<std::string>& channel_names) {
    write_text_file(file, encoded(file, format, image, integer_bits, channel_names));
}

using OpenPicture = std::unique_ptr<void, ClosePicture>;

/// Of `bytes`, or without them of the file itself.
OpenPicture opened(const std::filesystem::path& file,
                   std::string_view bytes,
                   const char* format,
                   PictureHeader& header) {
    if (!format) throw FileError(file, "", "content of another kind", kReadable);
    PictureError error;
    OpenPicture picture(
        module_table().open(file.c_str(), bytes.data(), bytes.size(), format, &header, &error));
    if (!picture) throw FileError(file, "", error.text, kReadable);
    return picture;
}

/// Of `bytes`, or without them of the file itself, which has `size` bytes.
ImageFile read_pixels(const std::filesystem::path& file,
                      std::string_view bytes,
                      std::uintmax_t size,
                      const char* format,
                      std::size_t max_pixels) {
    PictureHeader header;
    const auto picture = opened(file, bytes, format, header);
    check_size(file, size, header, max_pixels);

    ImageFile result;
    result.image = ImageF(header.width, header.height, header.channels);
    for (int c = 0; c < header.channels; ++c) {
        result.channel_names.emplace_back(module_table().channel_name(picture.get(), c));
    }
    result.settings = header.settings;
    result.floating_point = header.integer_bits == 0;
    result.full_scale = result.floating_point ? 1.0 : header.integer_bits == 8 ? 255.0 : 65535.0;
    PictureError error;
    if (!module_table().read(picture.get(), result.image.values.data(), &error)) {
        throw FileError(file, "", error.text, kReadable);
    }
    return result;
}

void check_png_channels(int channels) {
    check_argument(channels == 1 || channels == 3,
                   "write_png: " + std::to_string(channels) + " channels; 1 or 3 can be written");
}

}  // namespace

ImageFile read_image(const std::filesystem::path& file, std::size_t max_pixels, bool raw_half) {
    const char* format = format_of(file, start_of(file));
    if (raw_half && format && std::string_view(format) == "raw") format = kRawHalf;
    if (format && std::string_view(format) == "hdr") {
        const std::string bytes = read_text_file(file, kMaxBytes);
        if (auto picture = decode_radiance_hdr(bytes, max_pixels)) {
            return {std::move(*picture), {"R", "G", "B"}, 1.0, true, {}};
        }
    }
    std::error_code error;
    const auto bytes = std::filesystem::file_size(file, error);
    const auto most = std::numeric_limits<std::uintmax_t>::max();
    return read_pixels(file, {}, error ? most : bytes, format, max_pixels);
}

ExposureSettings read_exposure_settings(const std::filesystem::path& file) {
    const char* format = format_of(file, start_of(file));
    const std::string_view name = format ? format : "";
    if (name == "png" || name == "hdr") return {};
    PictureHeader header;
    opened(file, {}, format, header);
    return header.settings;
}

ImageFile read_image_bytes(std::string_view bytes,
                           const std::filesystem::path& name,
                           std::size_t max_pixels) {
    return read_pixels(name, bytes, bytes.size(), format_of("", bytes), max_pixels);
}

void write_exr(const std::filesystem::path& file,
               const ImageF& image,
               const std::vector<std::string>& channel_names) {
    check_argument(
        channel_names.empty() || channel_names.size() == static_cast<std::size_t>(image.channels),
        "write_exr: " + std::to_string(channel_names.size()) + " channel names for " +
            std::to_string(image.channels) + " channels");
    const auto names = !channel_names.empty() || image.channels != 1
                           ? channel_names
                           : std::vector<std::string>{"Y"};
    write_image(file, "openexr", image, 0, names);
}

void write_png(const std::filesystem::path& file, const Image8& image) {
    check_png_channels(image.channels);
    write_image(file, "png", image, 8, {});
}

void write_png(const std::filesystem::path& file, const Image16& image) {
    check_png_channels(image.channels);
    write_image(file, "png", image, 16, {});
}

std::string png_bytes(const Image8& image) {
    check_png_channels(image.channels);
    return encoded("a picture", "png", image, 8, {});
}

bool is_raw_suffix(const std::filesystem::path& file) {
    static constexpr std::string_view suffixes[] = {
        ".arw", ".cr2", ".cr3", ".dng", ".nef", ".orf", ".pef", ".raf", ".rw2", ".srw"};
    return has_suffix_among(file, suffixes);
}

bool has_picture_suffix(const std::filesystem::path& file) {
    static constexpr std::string_view suffixes[] = {
        ".exr", ".hdr", ".png", ".tif", ".tiff", ".jpg", ".jpeg"};
    return has_suffix_among(file, suffixes) || is_raw_suffix(file);
}

}  // namespace livery
