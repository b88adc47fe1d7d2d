#include "mesh/gltf/gltf_container.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "core/colour.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/utf8.h"
#include "mesh/beside.h"
#include "mesh/gltf/gltf_parts.h"

namespace livery {

namespace {

/// Of all buffers together.
constexpr std::size_t kMaxBufferBytes = 1u << 30u;

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;)
        value = (value << 8u) | static_cast<unsigned char>(bytes[at + k]);
    return value;
}

std::string decode_base64(const JsonReader& uri, std::string_view text) {
    static constexpr std::string_view alphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const auto digit = alphabet.find(c);
        if (digit == std::string_view::npos) uri.fail("a character that is not base64", "base64");
        bits = (bits << 6u) | static_cast<std::uint32_t>(digit);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes.push_back(static_cast<char>((bits >> static_cast<unsigned>(held)) & 0xffu));
    }
    return bytes;
}

/// "a%20b.bin" -> "a b.bin".
std::string decode_percent(const JsonReader& uri, std::string_view text) {
    const auto hex = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
    };
    std::string out;
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] != '%') {
            out.push_back(text[k]);
            continue;
        }
        const int high = k + 2 < text.size() ? hex(text[k + 1]) : -1;
        const int low = k + 2 < text.size() ? hex(text[k + 2]) : -1;
        if (high < 0 || low < 0) uri.fail(uri.found(), "two hexadecimal digits after %");
        out.push_back(static_cast<char>(16 * high + low));
        k += 2;
    }
    return out;
}

/// The first `bytes` of a file that has them: what lies behind is not asked for.
std::string read_beginning(const std::filesystem::path& file, std::size_t bytes) {
    std::string text(bytes, '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(text.data(), static_cast<std::streamsize>(bytes))) {
        throw FileError(file, "", "a read error", "a readable file");
    }
    return text;
}

}  // namespace

GlbChunks split_glb(const std::string& bytes, const std::filesystem::path& file) {
    constexpr std::uint32_t json_chunk = 0x4e4f534au, binary_chunk = 0x004e4942u;
    const auto count = [](std::uint64_t n) { return std::to_string(n) + " bytes"; };
    if (bytes.size() < 20) {
        throw FileError(file, "header", count(bytes.size()), "a GLB header and a JSON chunk");
    }
    if (const auto version = little_endian(bytes, 4); version != 2) {
        throw FileError(file, "header", "GLB version " + std::to_string(version), "version 2");
    }
    const std::uint32_t length = little_endian(bytes, 8);
    if (length > bytes.size()) {
        throw FileError(file, "header", count(bytes.size()) + " (cut off)", count(length));
    }
    GlbChunks glb;
    std::size_t at = 12;
    for (int chunk = 0; at + 8 <= length; ++chunk) {
        const std::string name = "chunk " + std::to_string(chunk);
        const std::uint32_t size = little_endian(bytes, at), type = little_endian(bytes, at + 4);
        at += 8;
        if (size > length - at) {
            throw FileError(file, name, count(size) + " declared", "at most " + count(length - at));
        }
        if (chunk == 0 && type != json_chunk) throw FileError(file, name, "no JSON", "JSON first");
        if (chunk == 0) glb.json = bytes.substr(at, size);
        if (chunk == 1 && type == binary_chunk) {
            glb.binary = bytes.substr(at, size);
        }
        at += size;
    }
    return glb;
}

GltfUri resolve_gltf_uri(const JsonReader& uri) {
    const std::string text = uri.text();
    if (text.starts_with("data:")) {
        const auto comma = text.find(',');
        if (comma == std::string::npos) uri.fail(uri.found(), "a data URI with a comma");
        const std::string_view data = std::string_view(text).substr(comma + 1);
        const bool base64 = std::string_view(text).substr(0, comma).ends_with(";base64");
        return {base64 ? decode_base64(uri, data) : decode_percent(uri, data), std::nullopt};
    }
    return {std::nullopt, path_beside(uri.file(), decode_percent(uri, text))};
}

std::size_t BufferContents::find(const JsonReader& buffer,
                                 std::size_t index,
                                 std::size_t declared) {
    if (!buffer.has("uri")) {
        if (index > 0 || !binary_) return none;
        return add(std::move(*std::exchange(binary_, std::nullopt)));
    }
    GltfUri uri = resolve_gltf_uri(buffer["uri"]);
    if (uri.inside) return add(std::move(*uri.inside));
    if (!uri.beside) return none;
    std::error_code error;
    auto same_file = std::filesystem::canonical(*uri.beside, error);
    if (error) same_file = *uri.beside;
    const auto [known, is_new] = of_file_.try_emplace(std::move(same_file));
    if (is_new) {
        known->second = add(read_wanted(*uri.beside, declared));
    } else if (std::string& content = contents_[known->second]; content.size() < declared) {
        bytes_ -= content.size();
        content = read_wanted(*uri.beside, declared);
        count(content.size());
    }
    return known->second;
}

std::string BufferContents::read_wanted(const std::filesystem::path& file,
                                        std::size_t declared) const {
    std::error_code error;
    const bool more = std::filesystem::is_regular_file(file, error) &&
                      std::filesystem::file_size(file, error) > declared && !error;
    const std::size_t left = kMaxBufferBytes - bytes_;
    return more && declared <= left ? read_beginning(file, declared) : read_text_file(file, left);
}

std::size_t BufferContents::add(std::string bytes) {
    count(bytes.size());
    contents_.push_back(std::move(bytes));
    return contents_.size() - 1;
}

void BufferContents::count(std::size_t bytes) {
    bytes_ += bytes;
    if (bytes_ <= kMaxBufferBytes) return;
    throw FileError(gltf_,
                    "buffers",
                    std::to_string(bytes_) + " bytes",
                    "at most " + std::to_string(kMaxBufferBytes) + " in all");
}

namespace {

constexpr std::size_t kMostPixelsASide = 4096;
/// Of all pictures of a file as they are kept: half a gigabyte.
constexpr std::size_t kMostTexels = 1u << 25u;
constexpr std::size_t kFewestASide = 64;
/// Decoded of one file: a few seconds' work.
constexpr std::size_t kMostPixels = 1u << 27u;

/// Of whole numbers of 8 or 16 bits, exactly.
float decoded(float encoded) {
    static const std::vector<float> table = [] {
        std::vector<float> values(65536);
        for (std::size_t k = 0; k < values.size(); ++k) {
            values[k] = static_cast<float>(srgb_decode(static_cast<double>(k) / 65535.0));
        }
        return values;
    }();
    return table[static_cast<std::size_t>(encoded * 65535.0f + 0.5f)];
}

void make_linear(ArtworkPicture& picture) {
    if (!std::exchange(picture.linear, true)) {
        for (std::size_t i = 0; i < picture.rgba.values.size(); ++i) {
            if (i % 4 != 3) picture.rgba.values[i] = decoded(picture.rgba.values[i]);
        }
    }
}

}  // namespace

ImageF resampled(const ImageF& picture, int width, int height) {
    if (picture.width == width && picture.height == height) return picture;
    ImageF to(width, height, picture.channels);
    const auto begin_of = [](int k, int count, int from) {
        return static_cast<int>(std::int64_t{k} * from / count);
    };
    for (int y = 0; y < height; ++y) {
        const int y0 = begin_of(y, height, picture.height);
        const int y1 = std::max(begin_of(y + 1, height, picture.height), y0 + 1);
        for (int x = 0; x < width; ++x) {
            const int x0 = begin_of(x, width, picture.width);
            const int x1 = std::max(begin_of(x + 1, width, picture.width), x0 + 1);
            const float share = 1.0f / static_cast<float>((x1 - x0) * (y1 - y0));
            for (int row = y0; row < y1; ++row) {
                for (int column = x0; column < x1; ++column) {
                    for (int c = 0; c < picture.channels; ++c) {
                        to.at(x, y, c) += share * picture.at(column, row, c);
                    }
                }
            }
        }
    }
    return to;
}

GltfPictures::GltfPictures(const GltfFile& gltf) : gltf_(gltf), pixels_left_(kMostPixels) {
    const std::size_t count = gltf.root().has("images") ? gltf.root()["images"].size() : 0;
    for (most_a_side_ = kMostPixelsASide;
         count * most_a_side_ * most_a_side_ > kMostTexels && most_a_side_ > kFewestASide;) {
        most_a_side_ /= 2;
    }
}

const GltfPicture& GltfPictures::of_texture(int texture, bool colours) {
    const tinygltf::Texture& from = gltf_.model.textures[static_cast<std::size_t>(texture)];
    const int image = from.source >= 0 ? from.source : -1 - texture;
    const auto [known, is_new] = read_.try_emplace({image, colours});
    if (!is_new) return known->second;
    if (from.source >= 0) return known->second = read(image, colours);
    known->second.note = "a texture without a picture";
    for (const auto& [name, extension] : from.extensions) {
        if (extension.Has("source")) known->second.note = "a picture by " + name + " is not read";
    }
    return known->second;
}

GltfPicture GltfPictures::read(int index, bool colours) {
    const auto image = gltf_.root()["images"].at(static_cast<std::size_t>(index));
    const bool inside = !image.has("uri") || image["uri"].text().starts_with("data:");
    const std::string name =
        inside ? "an embedded picture"
               : fmt::format("the picture \"{}\"", printable(image["uri"].text(), 100));
    try {
        const std::size_t most = std::min(kMostPixelsASide * kMostPixelsASide, pixels_left_);
        ImageFile file;
        std::filesystem::path path = fmt::format("images[{}]", index);
        if (image.has("uri")) {
            const GltfUri uri = resolve_gltf_uri(image["uri"]);
            if (uri.inside) {
                file = read_image_bytes(*uri.inside, path, most);
            } else if (!uri.beside) {
                return {nullptr, name + " is not read: it is not beside the model"};
            } else if (std::error_code error; !std::filesystem::exists(*uri.beside, error)) {
                return {nullptr, name + " is missing"};
            } else {
                path = *uri.beside;
                file = read_image(path, most);
            }
        } else if (image.has("bufferView")) {
            const int view = image["bufferView"].integer(0, 0x7fffffff);
            file = read_image_bytes(gltf_.view(static_cast<std::size_t>(view)), path, most);
        } else {
            return {nullptr, name + " is not read: neither a uri nor a bufferView"};
        }
        pixels_left_ -= file.image.pixel_count();
        ArtworkPicture picture = artwork_picture_of(file, path);
        if (colours) make_linear(picture);
        int width = picture.rgba.width, height = picture.rgba.height;
        while (static_cast<std::size_t>(std::max(width, height)) > most_a_side_) {
            width = std::max(width / 2, 1);
            height = std::max(height / 2, 1);
        }
        std::string note;
        if (width != picture.rgba.width || height != picture.rgba.height) {
            note = fmt::format("{} is shrunk to {}x{}", name, width, height);
        }
        picture.rgba = resampled(picture.rgba, width, height);
        return {std::make_shared<const ArtworkPicture>(std::move(picture)), note};
    } catch (const FileError& error) {
        return {
            nullptr,
            fmt::format("{} is not read: {}; expected {}", name, error.found(), error.expected())};
    }
}

}  // namespace livery
