#include "capture/manifest_io.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "capture/transfer.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kNewestVersion = 1;
constexpr int kLargestSide_px = 16384;
constexpr std::size_t kMostCaptures = 10'000;
constexpr std::size_t kMostPictures = 1000;

/// Our own manifests carry a version; a photographer's or a renderer's need not.
void check_manifest(const JsonReader& root) {
    root.allow_only({"format_version",
                     "projector",
                     "captures",
                     "exposure_s",
                     "transfer",
                     "black_level",
                     "saturates_at",
                     "raw_half",
                     "camera",
                     "sphere",
                     "white_reference"});
    if (root.has("format_version")) root.require_format_version(kNewestVersion);
    const auto captures = root["captures"];
    if (captures.size() == 0) captures.fail("an empty list", "at least one capture");
    if (captures.size() > kMostCaptures) {
        captures.fail(std::to_string(captures.size()) + " captures",
                      "at most " + std::to_string(kMostCaptures));
    }
}

std::pair<int, int> read_projector(const JsonReader& projector) {
    if (projector.size() != 2) {
        projector.fail(std::to_string(projector.size()) + " elements", "[width, height]");
    }
    return {projector.at(0).integer(1, kLargestSide_px),
            projector.at(1).integer(1, kLargestSide_px)};
}

std::string read_role(const JsonReader& role) {
    const std::string text = role.text();
    if (!is_known_role(text)) {
        role.fail("\"" + text + "\"",
                  "a known role (gray-column-0, white, dark-gray, ...; see docs/files.md)");
    }
    return text;
}

/// [R, G, B], one number for all three, or an empty list for a picture that is not uniform.
std::vector<int> read_drive(const JsonReader& drive) {
    if (drive.is_number()) return std::vector<int>(3, drive.integer(0, 255));
    if (drive.is_array() && drive.size() == 0) return {};
    if (!drive.is_array() || drive.size() != 3) drive.fail(drive.found(), "[R, G, B]");
    return {drive.at(0).integer(0, 255), drive.at(1).integer(0, 255), drive.at(2).integer(0, 255)};
}

/// Nobody has photographed these patterns yet.
bool is_unphotographed(const Json& manifest) {
    const auto found = manifest.find("captures");
    if (found == manifest.end() || !found->is_array() || found->empty()) return false;
    return std::all_of(found->begin(), found->end(), [](const Json& capture) {
        return capture.is_object() && capture.contains("pattern") &&
               capture.contains("exposure_s") && capture["exposure_s"].is_null() &&
               capture.contains("file") && capture["file"] == capture["pattern"];
    });
}

}  // namespace

bool is_patterns_manifest(const std::filesystem::path& manifest) {
    return is_unphotographed(read_json_file(manifest));
}

void allow_capture_fields(const JsonReader& entry) {
    entry.allow_only({"file",
                      "pattern",
                      "role",
                      "drive",
                      "exposure_s",
                      "transfer",
                      "black_level",
                      "saturates_at",
                      "raw_half",
                      "light_position_mm"});
}

std::filesystem::path read_photograph_name(const JsonReader& entry,
                                           const std::filesystem::path& folder) {
    const auto file = folder / entry["file"].text();
    if (std::error_code error; !std::filesystem::is_regular_file(file, error)) {
        entry["file"].fail("no such file: " + file.string(), "a photograph");
    }
    return file;
}

std::vector<Capture> read_pictures(const JsonReader& owner,
                                   std::string_view name,
                                   const std::vector<JsonReader>& places,
                                   const std::filesystem::path& folder) {
    const auto list = owner[name];
    if (list.size() == 0) list.fail("an empty list", "at least one photograph");
    if (list.size() > kMostPictures) {
        list.fail(std::to_string(list.size()) + " captures",
                  "at most " + std::to_string(kMostPictures));
    }
    std::vector<Capture> captures;
    for (std::size_t k = 0; k < list.size(); ++k) {
        const auto entry = list.at(k);
        entry.allow_only(
            {"file", "exposure_s", "transfer", "black_level", "saturates_at", "raw_half"});
        Capture capture;
        capture.file = read_photograph_name(entry, folder);
        std::vector<JsonReader> all{entry};
        all.insert(all.end(), places.begin(), places.end());
        read_settings(all, folder, capture);
        captures.push_back(std::move(capture));
    }
    return captures;
}

void read_settings(const std::vector<JsonReader>& places,
                   const std::filesystem::path& folder,
                   Capture& capture) {
    const auto setting = [&](const char* name) -> std::optional<JsonReader> {
        for (const JsonReader& place : places) {
            if (place.has(name)) return place[name];
        }
        return std::nullopt;
    };
    const std::string& entry = places.front().field();
    capture.exposure_field = entry + (entry.empty() ? "" : ".") + "exposure_s";
    for (const JsonReader& place : places) {
        // As livery patterns writes it, for somebody to fill in: null.
        if (!place.has("exposure_s") || place["exposure_s"].found() == "null") continue;
        capture.exposure_s = place["exposure_s"].number_between(1e-9, 1e6);
        break;
    }
    if (const auto transfer = setting("transfer")) {
        capture.transfer = transfer->text();
        if (capture.transfer != "linear" && capture.transfer != "srgb") {
            const auto response = folder / capture.transfer;
            if (std::error_code error; !std::filesystem::is_regular_file(response, error)) {
                transfer->fail("\"" + capture.transfer + "\"",
                               "\"linear\", \"srgb\" or a response file");
            }
            capture.transfer = response.string();
        }
    }
    if (const auto black = setting("black_level")) {
        capture.black_level = black->number_between(0.0, 1e9);
    }
    if (const auto saturates_at = setting("saturates_at")) {
        capture.saturates_at = saturates_at->number_between(0.0, 1e9);
        if (capture.saturates_at <= capture.black_level) {
            saturates_at->fail(saturates_at->found(), "more than black_level");
        }
    }
    if (const auto half = setting("raw_half")) capture.raw_half = half->boolean();
}

CapturesFolder read_captures_manifest(const std::filesystem::path& manifest) {
    return parse_captures_manifest(read_text_file(manifest), manifest);
}

CapturesFolder parse_captures_manifest(const std::string& text,
                                       const std::filesystem::path& manifest) {
    const Json json = parse_json(text, manifest);
    const JsonReader root(manifest, json);
    check_manifest(root);
    if (is_unphotographed(json) && !root.has("exposure_s")) {
        root["captures"].fail(
            "patterns that nobody has photographed: each file is the pattern itself",
            "the photographs' names in file, and exposure_s filled in where their EXIF has none");
    }

    CapturesFolder result;
    result.folder = manifest.parent_path();
    std::tie(result.projector_width, result.projector_height) = read_projector(root["projector"]);

    std::set<std::pair<std::string, std::string>> seen;
    const auto captures = root["captures"];
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const auto entry = captures.at(k);
        allow_capture_fields(entry);
        Capture capture;
        capture.role = read_role(entry["role"]);
        read_settings({entry, root}, result.folder, capture);
        // A role may come again, for more shots of one picture; not with the same file.
        if (!seen.insert({capture.role, entry["file"].text()}).second) {
            entry["file"].fail("\"" + entry["file"].text() + "\" a second time",
                               "each photograph once");
        }
        capture.file = read_photograph_name(entry, result.folder);
        if (entry.has("pattern")) capture.pattern = result.folder / entry["pattern"].text();
        if (entry.has("drive")) capture.drive = read_drive(entry["drive"]);
        result.captures.push_back(std::move(capture));
    }
    return result;
}

PatternsManifest read_patterns_manifest(const std::filesystem::path& manifest) {
    return parse_patterns_manifest(read_text_file(manifest), manifest);
}

PatternsManifest parse_patterns_manifest(const std::string& text,
                                         const std::filesystem::path& manifest) {
    const Json json = parse_json(text, manifest);
    const JsonReader root(manifest, json);
    check_manifest(root);
    PatternsManifest result;
    std::tie(result.projector_width, result.projector_height) = read_projector(root["projector"]);
    const auto captures = root["captures"];
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const auto entry = captures.at(k);
        result.patterns.push_back(
            {entry["pattern"].text(),
             read_role(entry["role"]),
             entry.has("drive") ? read_drive(entry["drive"]) : std::vector<int>{}});
    }
    return result;
}

void write_patterns_manifest(const std::filesystem::path& manifest,
                             const PatternsManifest& patterns) {
    Json json;
    json["format_version"] = kNewestVersion;
    json["projector"] = {patterns.projector_width, patterns.projector_height};
    json["captures"] = Json::array();
    for (const auto& pattern : patterns.patterns) {
        json["captures"].push_back({{"file", pattern.file},
                                    {"pattern", pattern.file},
                                    {"role", pattern.role},
                                    {"drive", pattern.drive},
                                    {"exposure_s", nullptr},
                                    {"transfer", "linear"}});
    }
    write_json_file(manifest, json);
}

void write_captures_manifest(const CapturesFolder& folder) {
    Json json;
    json["format_version"] = kNewestVersion;
    json["projector"] = {folder.projector_width, folder.projector_height};
    json["captures"] = Json::array();
    for (const Capture& capture : folder.captures) {
        Json entry = {{"file", capture.file.string()},
                      {"role", capture.role},
                      {"exposure_s", capture.exposure_s},
                      {"transfer", capture.transfer},
                      {"black_level", capture.black_level}};
        if (capture.saturates_at > 0.0) entry["saturates_at"] = capture.saturates_at;
        if (capture.raw_half) entry["raw_half"] = true;
        json["captures"].push_back(std::move(entry));
    }
    write_json_file(folder.folder / "manifest.json", json);
}

std::vector<double> read_response(const std::filesystem::path& file) {
    return parse_response(read_text_file(file), file);
}

void write_response(const std::filesystem::path& file,
                    const std::vector<double>& linear_from_file) {
    write_json_file(file,
                    {{"format_version", kNewestVersion}, {"linear_from_file", linear_from_file}});
}

std::vector<double> parse_response(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.allow_only({"format_version", "linear_from_file"});
    root.require_format_version(kNewestVersion);
    const auto table = root["linear_from_file"];
    if (table.size() < 2 || table.size() > 65536) {
        table.fail(std::to_string(table.size()) + " elements", "2 to 65536 numbers");
    }
    auto values = table.numbers(table.size());
    for (std::size_t k = 0; k < values.size(); ++k) {
        table.at(k).number_between(k == 0 ? 0.0 : values[k - 1], 1.0);
    }
    return values;
}

glm::dvec3 read_place_mm(const JsonReader& field) { return vec3_within(field, kFarthestPlace_mm); }

SpherePlace read_sphere_place(const JsonReader& sphere) {
    sphere.allow_only({"centre_mm", "diameter_mm"});
    return {read_place_mm(sphere["centre_mm"]),
            sphere["diameter_mm"].number_between(kSmallestSphere_mm, kFarthestPlace_mm)};
}

glm::dvec3 read_share(const JsonReader& share, double lowest) {
    if (share.is_number()) return glm::dvec3(share.number_between(lowest, 1.0));
    if (!share.is_array() || share.size() != 3) {
        share.fail(share.found(), "a share of the light, or [R, G, B]");
    }
    glm::dvec3 result;
    for (int c = 0; c < 3; ++c) {
        result[c] = share.at(static_cast<std::size_t>(c)).number_between(lowest, 1.0);
    }
    return result;
}

std::filesystem::path manifest_in(const std::filesystem::path& folder) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) {
        throw FileError(folder,
                        "",
                        std::filesystem::exists(folder, error) ? "a file" : "no such folder",
                        "a folder of photographs with manifest.json");
    }
    return folder / "manifest.json";
}

CameraText read_camera_text(const JsonReader& owner,
                            const Json& json,
                            const std::filesystem::path& manifest) {
    const auto camera = owner["camera"];
    if (camera.is_text()) {
        const auto file = manifest.parent_path() / camera.text();
        return {read_text_file(file), file.string()};
    }
    if (!camera.is_object()) {
        camera.fail(camera.found(), "a camera file's fields or its name (docs/files.md)");
    }
    return {json["camera"].dump(), manifest.string() + ": " + camera.field()};
}

}  // namespace livery
