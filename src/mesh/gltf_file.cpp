#include "mesh/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/error.h"
#include "core/paths.h"
#include "mesh/beside.h"

namespace livery {

namespace {

/// Of all buffers together.
constexpr std::size_t kMaxBufferBytes = 1u << 30u;
constexpr int kMaxInt = std::numeric_limits<int>::max();

/// Extensions that a file may require: quantised attributes are read; the others change only how
/// pictures, lights and materials look, and load_mesh notes that they are not read.
bool may_be_required(const std::string& extension) {
    return extension == "KHR_mesh_quantization" || extension == "KHR_texture_transform" ||
           extension == "KHR_lights_punctual" || extension == "KHR_texture_basisu" ||
           extension.starts_with("KHR_materials_");
}

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;)
        value = (value << 8u) | static_cast<unsigned char>(bytes[at + k]);
    return value;
}

struct Glb {
    std::string json, binary;
    bool has_binary = false;
};

Glb split_glb(const std::filesystem::path& file, const std::string& bytes) {
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
    Glb glb;
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
            glb.has_binary = true;
        }
        at += size;
    }
    return glb;
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

/// The contents of buffers: a file that several of them name is read once, as far as the longest
/// of them goes.
class BufferContents {
  public:
    BufferContents(GltfFile& gltf, Glb& glb) : gltf_(gltf), glb_(glb) {}

    /// Which of gltf.contents a buffer is, of which `declared` bytes are wanted.
    std::size_t find(const JsonReader& buffer, std::size_t index, std::size_t declared) {
        if (!buffer.has("uri") && index == 0 && glb_.has_binary) return add(std::move(glb_.binary));
        const auto uri = buffer["uri"];
        const std::string text = uri.text();
        if (text.starts_with("data:")) {
            const auto comma = text.find(";base64,");
            if (comma == std::string::npos) uri.fail(uri.found(), "a data URI in base64");
            return add(decode_base64(uri, std::string_view(text).substr(comma + 8)));
        }
        const auto beside = path_beside(gltf_.path, decode_percent(uri, text));
        if (!beside) uri.fail(uri.found(), "a file beside the model or below its folder");
        std::error_code error;
        auto same_file = std::filesystem::canonical(*beside, error);
        if (error) same_file = *beside;
        const auto [known, is_new] = of_file_.try_emplace(std::move(same_file));
        if (is_new) {
            known->second = add(read_wanted(*beside, declared));
        } else if (std::string& content = gltf_.contents[known->second];
                   content.size() < declared) {
            bytes_ -= content.size();
            content = read_wanted(*beside, declared);
            count(content.size());
        }
        return known->second;
    }

  private:
    /// As much as is wanted of a file that may hold more; all of one that holds less.
    std::string read_wanted(const std::filesystem::path& file, std::size_t declared) const {
        std::error_code error;
        const bool more = std::filesystem::is_regular_file(file, error) &&
                          std::filesystem::file_size(file, error) > declared && !error;
        const std::size_t left = kMaxBufferBytes - bytes_;
        return more && declared <= left ? read_beginning(file, declared)
                                        : read_text_file(file, left);
    }

    std::size_t add(std::string bytes) {
        count(bytes.size());
        gltf_.contents.push_back(std::move(bytes));
        return gltf_.contents.size() - 1;
    }

    void count(std::size_t bytes) {
        bytes_ += bytes;
        if (bytes_ > kMaxBufferBytes) {
            throw FileError(gltf_.path,
                            "buffers",
                            std::to_string(bytes_) + " bytes",
                            "at most " + std::to_string(kMaxBufferBytes) + " in all");
        }
    }

    GltfFile& gltf_;
    Glb& glb_;
    std::map<std::filesystem::path, std::size_t> of_file_;
    std::size_t bytes_ = 0;
};

void check_header(const GltfFile& gltf) {
    const auto version = gltf.root()["asset"]["version"];
    if (!version.text().starts_with("2.")) version.fail(version.found(), "glTF 2.0");
    const auto asset = gltf.root()["asset"];
    if (asset.has("minVersion")) {
        const auto least = asset["minVersion"];
        if (least.text() != "2.0") least.fail(least.found(), "2.0, the newest that is known");
    }
    if (!gltf.root().has("extensionsRequired")) return;
    const auto required = gltf.root()["extensionsRequired"];
    for (std::size_t k = 0; k < required.size(); ++k) {
        const auto name = required.at(k);
        if (may_be_required(name.text())) continue;
        name.fail("the extension " + name.text(), "a mesh that does not need it (export without)");
    }
}

}  // namespace

int integer_or(const JsonReader& object, std::string_view key, int low, int high, int otherwise) {
    return object.has(key) ? object[key].integer(low, high) : otherwise;
}

std::string name_or(const JsonReader& object, const std::string& otherwise) {
    if (!object.has("name")) return otherwise;
    const std::string name = object["name"].text();
    return name.empty() ? otherwise : name;
}

std::size_t index_into(const JsonReader& root, std::string_view array, const JsonReader& index) {
    const std::size_t count = root.has(array) ? root[array].size() : 0;
    if (count == 0) index.fail(index.found(), "no index: there are no " + std::string(array));
    return static_cast<std::size_t>(index.integer(0, static_cast<int>(count) - 1));
}

GltfFile open_gltf(const std::string& bytes, const std::filesystem::path& file) {
    GltfFile gltf;
    gltf.path = file;
    Glb glb;
    if (bytes.starts_with("glTF")) {
        glb = split_glb(file, bytes);
        gltf.json = parse_json(glb.json, file);
    } else if (file.extension() != ".gltf") {
        throw FileError(
            file, "header", "no \"glTF\" at the start", "a .glb file, .gltf text, .ply or .obj");
    } else {
        gltf.json = parse_json(bytes, file);
    }
    check_header(gltf);

    if (!gltf.root().has("buffers")) return gltf;
    const auto buffers = gltf.root()["buffers"];
    BufferContents contents(gltf, glb);
    const std::size_t count = buffers.size();
    for (std::size_t k = 0; k < count; ++k) {
        const auto buffer = buffers.at(k);
        const auto declared = static_cast<std::size_t>(buffer["byteLength"].integer(1, kMaxInt));
        const std::size_t content = contents.find(buffer, k, declared);
        const std::size_t there = gltf.contents[content].size();
        if (there < declared) {
            buffer["byteLength"].fail(
                std::to_string(declared),
                "at most the " + std::to_string(there) + " bytes that the buffer has");
        }
        gltf.buffers.push_back({content, declared});
    }
    return gltf;
}

}  // namespace livery
