// The files that Khronos' validator is tested with, as they are and with a triangle to show.

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "mesh/gltf_builder.h"
#include "mesh/mesh.h"
#include "support/reference_data.h"

namespace livery {
namespace {

/// What glTF allows and is refused all the same, each with the field and the reason.
const std::map<std::string, std::string> kNotRead = {
    // A reader that knows 2.0 must leave such a file alone.
    {"asset/min_version_valid.gltf", "asset.minVersion"},
    // Their meshes' numbers are in no file: whoever wrote them hands the bytes over otherwise.
    {"root/named_objects.gltf", "buffers[0].uri"},
    {"root/unused_objects.gltf", "buffers[0].uri"},
};

struct Outcome {
    bool read = false;
    std::string field, message;
    std::vector<std::string> notes;
};

Outcome outcome_of(const std::string& bytes, const std::filesystem::path& file) {
    Outcome outcome;
    try {
        const Mesh mesh = read_mesh(bytes, file, &outcome.notes);
        outcome.read = !mesh.triangles.empty();
    } catch (const FileError& error) {
        outcome.field = error.field();
        outcome.message = error.what();
        EXPECT_FALSE(error.found().empty()) << file << ": " << error.what();
        EXPECT_FALSE(error.expected().empty()) << file << ": " << error.what();
        // A file of another name is a field of its own: a buffer that is not there.
        const bool names = !error.field().empty() || error.file() != file;
        EXPECT_TRUE(names || !Json::accept(bytes) || !Json::parse(bytes).is_object())
            << file << ": " << error.what();
    }
    return outcome;
}

Json& array_in(Json& object, const char* key) {
    if (!object.contains(key)) object[key] = Json::array();
    return object[key];
}

/// The JSON of a file with a triangle more, in a buffer of its own; nothing for what has no arrays
/// to put it into.
std::string with_triangle(const std::string& text) {
    if (!Json::accept(text)) return "";
    Json json = Json::parse(text);
    if (!json.is_object()) return "";
    for (const char* key : {"buffers", "bufferViews", "accessors", "meshes", "nodes"}) {
        if (!array_in(json, key).is_array()) return "";
    }
    // 0,0,0, 1,0,0, 0,1,0 as floats.
    json["buffers"].push_back({{"byteLength", 36},
                               {"uri",
                                "data:application/octet-stream;base64,"
                                "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}});
    json["bufferViews"].push_back({{"buffer", json["buffers"].size() - 1}, {"byteLength", 36}});
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", 3},
                                 {"type", "VEC3"},
                                 {"min", {0, 0, 0}},
                                 {"max", {1, 1, 0}}});
    json["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", json["accessors"].size() - 1}}}}}}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
    const std::size_t node = json["nodes"].size() - 1;
    if (json.contains("scenes") && json["scenes"].is_array() && !json["scenes"].empty()) {
        for (Json& scene : json["scenes"]) {
            if (scene.is_object() && array_in(scene, "nodes").is_array()) {
                scene["nodes"].push_back(node);
            }
        }
    }
    return json.dump();
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

/// A GLB's JSON chunk replaced; nothing where its header is not whole.
std::string glb_with_triangle(const std::string& bytes) {
    if (bytes.size() < 20 || word_at(bytes, 12) > bytes.size() - 20) return "";
    const std::size_t length = word_at(bytes, 12);
    std::string text = with_triangle(bytes.substr(20, length));
    if (text.empty()) return "";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string glb = bytes.substr(0, 20) + text + bytes.substr(20 + length);
    const auto put = [&](std::size_t at, std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        std::memcpy(glb.data() + at, &word, 4);
    };
    put(8, word_at(bytes, 8) + text.size() - length);
    put(12, text.size());
    return glb;
}

TEST(GltfConformance, EveryFileOfTheValidatorIsReadOrRefusedByName) {
    LIVERY_NEEDS_REFERENCE_DATA(data);
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(data / "gltf-validator")) {
        const auto suffix = entry.path().extension();
        if (suffix == ".gltf" || suffix == ".glb") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    EXPECT_EQ(files.size(), 372u);
    int read = 0, wrong_and_refused = 0, wrong = 0;
    for (const auto& file : files) {
        SCOPED_TRACE(file.string());
        const auto report = file.string() + ".report.json";
        const bool allowed =
            Json::parse(read_text_file(report))["issues"]["numErrors"].get<int>() == 0;
        const std::string name =
            file.parent_path().filename().string() + "/" + file.filename().string();
        const std::string bytes = read_text_file(file);
        outcome_of(bytes, file);

        const std::string more =
            file.extension() == ".glb" ? glb_with_triangle(bytes) : with_triangle(bytes);
        if (more.empty()) {
            EXPECT_FALSE(allowed);
            continue;
        }
        const Outcome outcome = outcome_of(more, file);
        read += outcome.read;
        wrong += !allowed;
        wrong_and_refused += !allowed && !outcome.read;
        if (const auto known = kNotRead.find(name); known != kNotRead.end()) {
            EXPECT_EQ(outcome.field, known->second) << outcome.message;
        } else if (allowed) {
            EXPECT_TRUE(outcome.read) << outcome.message;
        }
    }
    std::printf("%d read, %d of %d wrong ones refused\n", read, wrong_and_refused, wrong);
}

}  // namespace
}  // namespace livery
