#include <glm/geometric.hpp>

#include "capture/exposures.h"
#include "capture/manifest_io.h"
#include "capture/sphere_fields.h"
#include "capture/spot_folder.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

namespace {

constexpr int kNewestSpotVersion = 1;
constexpr double kDarkestSpotWhite = 0.05;  ///< darker is no white
constexpr double kFinest_mm = 1e-6, kCoarsest_mm = 100.0;

SpotPlaces read_places(const JsonReader& root,
                       const Json& json,
                       const std::filesystem::path& manifest) {
    SpotPlaces places;
    const auto plane = root["plane"];
    plane.allow_only({"point_mm", "normal"});
    places.point_mm = read_place_mm(plane["point_mm"]);
    const glm::dvec3 normal = vec3_within(plane["normal"], kLongestDirection);
    const double length = glm::length(normal);
    if (!(length > 1e-9)) plane["normal"].fail("no length", "a direction [x, y, z]");
    places.normal = normal / length;
    places.projector_mm = read_place_mm(root["projector_mm"]);
    if (root.has("incidence_deg")) {
        root["incidence_deg"].fail("beside a camera file", "projector_mm alone, which tells it");
    }
    const CameraText camera = read_camera_text(root, json, manifest);
    places.camera = camera.text;
    places.camera_origin = camera.origin;
    return places;
}

SpotScale read_scale(const JsonReader& root) {
    for (const char* name : {"plane", "projector_mm"}) {
        if (root.has(name)) {
            root[name].fail("beside mm_per_px", "a camera file with it, or mm_per_px alone");
        }
    }
    return {root["mm_per_px"].number_between(kFinest_mm, kCoarsest_mm),
            root["incidence_deg"].number_between(0.0, 90.0)};
}

SpotPictures read_surface(const JsonReader& owner,
                          const std::vector<JsonReader>& places,
                          const std::filesystem::path& folder) {
    return {read_pictures(owner, "captures", places, folder),
            read_pictures(owner, "black", places, folder)};
}

}  // namespace

bool is_spot_manifest(const std::filesystem::path& manifest) {
    const Json json = read_json_file(manifest);
    return json.contains("plane") || json.contains("mm_per_px") || json.contains("black");
}

SpotFolder read_spot_folder(const std::filesystem::path& folder) {
    const auto manifest = manifest_in(folder);
    SpotFolder result = parse_spot_manifest(read_text_file(manifest), manifest);
    std::vector<Capture*> all;
    for (SpotPictures* surface : {&result.sample, &result.white}) {
        for (Capture& capture : surface->lit) all.push_back(&capture);
        for (Capture& capture : surface->black) all.push_back(&capture);
    }
    complete_exposures(all, manifest, PhotographUse::light);
    return result;
}

SpotFolder parse_spot_manifest(const std::string& text, const std::filesystem::path& manifest) {
    const Json json = parse_json(text, manifest);
    const JsonReader root(manifest, json);
    if (root.has("format_version")) root.require_format_version(kNewestSpotVersion);
    root.allow_only({"format_version",
                     "camera",
                     "plane",
                     "projector_mm",
                     "mm_per_px",
                     "incidence_deg",
                     "captures",
                     "black",
                     "white_reference",
                     "exposure_s",
                     "transfer",
                     "black_level",
                     "saturates_at",
                     "raw_half"});
    SpotFolder result;
    result.manifest = manifest;
    if (root.has("camera") == root.has("mm_per_px")) {
        root.fail(root.has("camera") ? "camera and mm_per_px" : "neither camera nor mm_per_px",
                  "one of them: a camera file with its pose, or the scale of a camera that looks "
                  "along the normal");
    }
    if (root.has("camera")) {
        result.places = read_places(root, json, manifest);
    } else {
        result.scale = read_scale(root);
    }
    const auto white = root["white_reference"];
    white.allow_only({"reflectance",
                      "captures",
                      "black",
                      "exposure_s",
                      "transfer",
                      "black_level",
                      "saturates_at",
                      "raw_half"});
    result.white_reflectance = read_share(white["reflectance"], kDarkestSpotWhite);
    const auto folder = manifest.parent_path();
    result.sample = read_surface(root, {root}, folder);
    result.white = read_surface(white, {white, root}, folder);
    return result;
}

std::vector<Capture> photographs_of(const SpotFolder& folder) {
    std::vector<Capture> captures;
    for (const SpotPictures* surface : {&folder.sample, &folder.white}) {
        captures.insert(captures.end(), surface->lit.begin(), surface->lit.end());
        captures.insert(captures.end(), surface->black.begin(), surface->black.end());
    }
    return captures;
}

}  // namespace livery
