// open_gltf: guarded before tinygltf reads it, which refuses little by name and believes the rest.
#include <cmath>
#include <fstream>
#include <set>

#include "core/error.h"

#define TINYGLTF_IMPLEMENTATION
#include "mesh/gltf/gltf_container.h"
#include "mesh/gltf/gltf_file.h"

namespace livery {

namespace {

/// Extensions that a file may require: they are read, or change only how pictures, lights and
/// materials look, and the notes say that they are not read.
bool may_be_required(const std::string& extension) {
    return extension == "KHR_mesh_quantization" || extension == "KHR_texture_transform" ||
           extension == "KHR_lights_punctual" || extension == "KHR_texture_basisu" ||
           extension == "EXT_texture_webp" || extension == "KHR_node_visibility" ||
           extension == "KHR_animation_pointer" || extension.starts_with("KHR_materials_");
}

void check_header(const JsonReader& root) {
    const auto asset = root["asset"];
    const auto version = asset["version"];
    if (!version.text().starts_with("2.")) version.fail(version.found(), "glTF 2.0");
    if (asset.has("minVersion")) {
        const auto least = asset["minVersion"];
        if (least.text() != "2.0") least.fail(least.found(), "2.0, the newest that is known");
    }
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        for (std::size_t k = 0; root.has(list) && k < root[list].size(); ++k) {
            const auto name = root[list].at(k);
            const std::string extension = name.text();
            if (list == std::string_view("extensionsUsed") || may_be_required(extension)) continue;
            name.fail("the extension " + extension,
                      "a mesh that does not need it (export without)");
        }
    }
}

/// "Whole" numbers may be written as 4.0, which tinygltf takes for no number at all.
void write_whole_numbers_whole(Json& value) {
    if (value.is_number_float()) {
        const auto number = value.get<double>();
        if (number == std::floor(number) && std::abs(number) < 1e9) {
            value = static_cast<std::int64_t>(number);
        }
    } else if (value.is_structured()) {
        for (Json& member : value) write_whole_numbers_whole(member);
    }
}

/// The text that tinygltf reads: without files and pictures, which are opened here, without what is
/// left out, and without what it refuses though glTF allows it.
std::string text_for_tinygltf(Json json) {
    for (const char* member : {"buffers", "images", "animations", "skins", "cameras", "extras"}) {
        json.erase(member);
    }
    if (json.contains("extensions")) json["extensions"].erase("KHR_lights_punctual");
    if (json.contains("accessors")) {
        // It wants a buffer view for all indices; one behind the last stands for none.
        const std::size_t views = json.contains("bufferViews") ? json["bufferViews"].size() : 0;
        json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
        for (Json& accessor : json["accessors"]) {
            if (!accessor.contains("bufferView")) accessor["bufferView"] = views;
            static const std::set<std::string> known{
                "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
            // No attribute is a matrix: whoever reads it is refused.
            if (!known.contains(accessor["type"].get<std::string>())) accessor["type"] = "MAT4";
        }
    }
    write_whole_numbers_whole(json);
    return json.dump();
}

}  // namespace

void GltfFile::fail(std::string field, std::string found, std::string expected) const {
    throw FileError(path, std::move(field), std::move(found), std::move(expected));
}

bool GltfFile::has_view(const tinygltf::Accessor& accessor) const {
    return static_cast<std::size_t>(accessor.bufferView) + 1 < model.bufferViews.size();
}

std::string_view GltfFile::view(std::size_t index) const {
    const tinygltf::BufferView& view = model.bufferViews[index];
    const auto reader = root()["bufferViews"].at(index);
    const auto at = static_cast<std::size_t>(view.buffer);
    if (buffers[at].content == BufferContents::none) {
        for (const auto& [name, extension] : view.extensions) {
            if (name.ends_with("_meshopt_compression")) {
                reader.fail("a view compressed by " + name, "a copy that is not (export without)");
            }
        }
        const auto uri = root()["buffers"].at(at)["uri"];
        uri.fail(uri.found(), "a file beside the model or below its folder");
    }
    const std::string_view buffer =
        std::string_view(contents[buffers[at].content]).substr(0, buffers[at].bytes);
    // Both below 2^31, so that the sum is exact.
    if (view.byteOffset + view.byteLength > buffer.size()) {
        reader["byteLength"].fail(
            std::to_string(view.byteLength) + " from byte " + std::to_string(view.byteOffset),
            "an end within the buffer's " + std::to_string(buffer.size()) + " bytes");
    }
    return buffer.substr(view.byteOffset, view.byteLength);
}

GltfFile open_gltf(const std::string& bytes, const std::filesystem::path& file) {
    GltfFile gltf;
    gltf.path = file;
    GlbChunks glb;
    if (bytes.starts_with("glTF")) {
        glb = split_glb(bytes, file);
        gltf.json = parse_json(glb.json, file);
    } else if (file.extension() != ".gltf") {
        throw FileError(
            file, "header", "no \"glTF\" at the start", "a .glb file, .gltf text, .ply or .obj");
    } else {
        gltf.json = parse_json(bytes, file);
    }
    const JsonReader root = gltf.root();
    check_header(root);
    check_gltf_fields(root);

    BufferContents contents(file, std::move(glb.binary), gltf.contents);
    const std::size_t count = root.has("buffers") ? root["buffers"].size() : 0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto buffer = root["buffers"].at(k);
        const auto declared = static_cast<std::size_t>(buffer["byteLength"].integer(1, 0x7fffffff));
        const std::size_t content = contents.find(buffer, k, declared);
        if (content != BufferContents::none && gltf.contents[content].size() < declared) {
            buffer["byteLength"].fail(std::to_string(declared),
                                      "at most the " +
                                          std::to_string(gltf.contents[content].size()) +
                                          " bytes that the buffer has");
        }
        gltf.buffers.push_back({content, declared});
    }

    const std::string text = text_for_tinygltf(gltf.json);
    std::string error, warning;
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(
            &gltf.model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "")) {
        throw FileError(file, "glTF", error, "what tinygltf reads");
    }
    return gltf;
}

}  // namespace livery
