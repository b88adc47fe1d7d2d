#include <algorithm>

#include <glm/geometric.hpp>

#include "capture/exposures.h"
#include "capture/manifest_io.h"
#include "capture/sphere_fields.h"
#include "capture/sphere_folder.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kNewestSphereVersion = 1;
constexpr std::size_t kMostSphereCaptures = 10'000;
constexpr double kDarkestWhite = 0.05;  ///< darker is no white

std::optional<glm::dvec3> read_light(const JsonReader& entry, const SpherePlace& sphere) {
    if (!entry.has("light_position_mm")) return std::nullopt;
    const auto field = entry["light_position_mm"];
    const glm::dvec3 light = read_place_mm(field);
    if (2.0 * glm::distance(light, sphere.centre_mm) <= sphere.diameter_mm) {
        field.fail(field.found() + " inside the sphere", "a place outside of the sphere");
    }
    return light;
}

/// The settings in which all captures agree.
Json agreed_settings(const Json& captures) {
    Json agreed = Json::object();
    for (const char* name : {"exposure_s", "transfer", "black_level", "saturates_at"}) {
        const auto same = [&](const Json& capture) {
            return capture.is_object() && capture.contains(name) &&
                   capture[name] == captures[0][name];
        };
        if (std::all_of(captures.begin(), captures.end(), same)) agreed[name] = captures[0][name];
    }
    return agreed;
}

/// A photograph of the white sphere. What its own entry does not say, the one of the same file
/// among `captures` may, else the whole white_reference, else the manifest, else all captures.
SphereCapture read_white(const JsonReader& root,
                         const JsonReader& white,
                         const JsonReader& entry,
                         const JsonReader& agreed,
                         const SphereFolder& result) {
    SphereCapture capture;
    const auto folder = result.manifest.parent_path();
    capture.photograph.file = read_photograph_name(entry, folder);
    const auto captures = root["captures"];
    JsonReader same = entry;
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const auto other = captures.at(k);
        if (other["file"].text() == entry["file"].text()) same = other;
    }
    read_settings({entry, same, white, root, agreed}, folder, capture.photograph);
    const SpherePlace& sphere = result.white_sphere ? *result.white_sphere : result.sphere;
    for (const JsonReader& place : {entry, same, white}) {
        if (!capture.light_position_mm) capture.light_position_mm = read_light(place, sphere);
    }
    return capture;
}

void read_white_reference(const JsonReader& root, const Json& json, SphereFolder& result) {
    const auto white = root["white_reference"];
    white.allow_only({"file",
                      "captures",
                      "reflectance",
                      "sphere",
                      "exposure_s",
                      "transfer",
                      "black_level",
                      "saturates_at",
                      "light_position_mm"});
    result.white_reflectance = read_share(white["reflectance"], kDarkestWhite);
    if (white.has("sphere")) result.white_sphere = read_sphere_place(white["sphere"]);
    if (white.has("file") == white.has("captures")) {
        white.fail(white.has("file") ? "file and captures" : "neither file nor captures",
                   "one of them: photographs of the white sphere");
    }
    const Json settings = agreed_settings(json["captures"]);
    const JsonReader agreed(result.manifest, settings, "captures[0]");
    if (white.has("file")) {
        result.white.push_back(read_white(root, white, white, agreed, result));
        return;
    }
    const auto captures = white["captures"];
    if (captures.size() == 0) captures.fail("an empty list", "at least one photograph");
    for (std::size_t k = 0; k < captures.size(); ++k) {
        allow_capture_fields(captures.at(k));
        result.white.push_back(read_white(root, white, captures.at(k), agreed, result));
    }
}

bool is_white(const SphereFolder& result, const std::filesystem::path& file) {
    return std::any_of(result.white.begin(), result.white.end(), [&](const SphereCapture& white) {
        return white.photograph.file == file;
    });
}

}  // namespace

bool is_sphere_manifest(const std::filesystem::path& manifest) {
    const Json json = read_json_file(manifest);
    return json.contains("sphere") || json.contains("white_reference");
}

SphereFolder read_sphere_folder(const std::filesystem::path& folder) {
    const auto manifest = manifest_in(folder);
    SphereFolder result = parse_sphere_manifest(read_text_file(manifest), manifest);
    std::vector<Capture*> all;
    for (auto* list : {&result.captures, &result.white}) {
        for (SphereCapture& capture : *list) all.push_back(&capture.photograph);
    }
    complete_exposures(all, manifest, PhotographUse::light);
    return result;
}

SphereFolder parse_sphere_manifest(const std::string& text, const std::filesystem::path& manifest) {
    const Json json = parse_json(text, manifest);
    const JsonReader root(manifest, json);
    if (root.has("format_version")) root.require_format_version(kNewestSphereVersion);
    root.allow_only({"format_version",
                     "projector",
                     "captures",
                     "exposure_s",
                     "transfer",
                     "black_level",
                     "saturates_at",
                     "camera",
                     "camera_to_xyz",
                     "sphere",
                     "white_reference"});
    SphereFolder result;
    result.manifest = manifest;
    const auto captures = root["captures"];
    if (captures.size() == 0) captures.fail("an empty list", "at least one photograph");
    if (captures.size() > kMostSphereCaptures) {
        captures.fail(std::to_string(captures.size()) + " captures",
                      "at most " + std::to_string(kMostSphereCaptures));
    }
    result.sphere = read_sphere_place(root["sphere"]);
    const CameraText camera = read_camera_text(root, json, manifest);
    result.camera = camera.text;
    result.camera_origin = camera.origin;
    read_white_reference(root, json, result);
    for (std::size_t k = 0; k < captures.size(); ++k) {
        const auto entry = captures.at(k);
        allow_capture_fields(entry);
        SphereCapture capture;
        capture.photograph.file = read_photograph_name(entry, manifest.parent_path());
        if (is_white(result, capture.photograph.file)) continue;
        read_settings({entry, root}, manifest.parent_path(), capture.photograph);
        capture.light_position_mm = read_light(entry, result.sphere);
        if (!capture.light_position_mm) {
            throw FileError(manifest,
                            entry.field() + ".light_position_mm",
                            "nothing",
                            "where the light stood: [x, y, z] in mm");
        }
        result.captures.push_back(std::move(capture));
    }
    if (result.captures.empty()) {
        captures.fail("the white reference alone", "photographs of the painted sphere");
    }
    if (root.has("camera_to_xyz")) {
        result.camera_to_xyz = manifest.parent_path() / root["camera_to_xyz"].text();
    }
    return result;
}

}  // namespace livery
