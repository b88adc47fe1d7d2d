// The bytes of a glTF file: a GLB's chunks, and what its URIs name.
#include "mesh/gltf/gltf_container.h"

#include <algorithm>
#include <fstream>
#include <utility>

#include "core/error.h"
#include "core/paths.h"
#include "mesh/beside.h"

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

}  // namespace livery
