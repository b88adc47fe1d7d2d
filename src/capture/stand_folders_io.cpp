#include <algorithm>

#include <glm/geometric.hpp>

#include "capture/exposures.h"
#include "capture/manifest_io.h"
#include "capture/stand_folders.h"
#include "core/error.h"
#include "core/json.h"
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

namespace {

constexpr int kNewestEnvironmentVersion = 1;
constexpr std::size_t kMostViews = 100, kMostPoints = 10'000;
constexpr double kFarthest_px = 1e5;
constexpr double kDarkestBall = 0.02;

std::filesystem::path read_mask(const JsonReader& owner, const std::filesystem::path& folder) {
    if (!owner.has("mask")) return {};
    const auto file = folder / owner["mask"].text();
    if (std::error_code error; !std::filesystem::is_regular_file(file, error)) {
        owner["mask"].fail("no such file: " + file.string(), "a picture");
    }
    return file;
}

/// Files count pixel centres at integers, as OpenCV does.
glm::dvec2 read_pixel(const JsonReader& list) {
    const auto numbers = numbers_between(list, 2, -kFarthest_px, kFarthest_px);
    return {numbers[0] + 0.5, numbers[1] + 0.5};
}

std::vector<glm::dvec2> read_outline(const JsonReader& owner) {
    std::vector<glm::dvec2> points;
    if (!owner.has("outline_px")) return points;
    const auto list = owner["outline_px"];
    if (list.size() < 5 || list.size() > kMostPoints) {
        list.fail(std::to_string(list.size()) + " points",
                  "5 to " + std::to_string(kMostPoints) + " points [x, y] of the ball's outline");
    }
    for (std::size_t k = 0; k < list.size(); ++k) points.push_back(read_pixel(list.at(k)));
    return points;
}

/// What a view does not say, the manifest's top may.
JsonReader place_of(const char* name, const JsonReader& view, const JsonReader& root) {
    return view.has(name) || !root.has(name) ? view : root;
}

void read_ball(const JsonReader& view, const JsonReader& root, BallView& ball) {
    const auto sphere = place_of("sphere", view, root)["sphere"];
    sphere.allow_only({"centre_mm", "diameter_mm"});
    ball.diameter_mm = sphere["diameter_mm"].number_between(kSmallestSphere_mm, kFarthestPlace_mm);
    if (sphere.has("centre_mm")) ball.centre_mm = read_place_mm(sphere["centre_mm"]);
    ball.outline_px = read_outline(view);
    const auto fit = place_of("fit_outline", view, root);
    if (fit.has("fit_outline")) ball.fit_outline = fit["fit_outline"].boolean();
    const auto camera = place_of("camera_deg", view, root);
    if (camera.has("camera_deg")) ball.camera_deg = camera["camera_deg"].number_between(0.0, 90.0);
    if (!ball.centre_mm && ball.outline_px.empty()) {
        sphere.fail("neither sphere.centre_mm nor outline_px",
                    "where the ball stands, or points of its outline in the picture");
    }
}

BallView read_view(const JsonReader& view,
                   const JsonReader& root,
                   const Json& json,
                   const std::filesystem::path& manifest) {
    BallView ball;
    if (!view.field().empty()) ball.field = view.field() + ".";
    const CameraText camera = read_camera_text(view, json, manifest);
    ball.camera = camera.text;
    ball.camera_origin = camera.origin;
    read_ball(view, root, ball);
    ball.mask = read_mask(view, manifest.parent_path());
    ball.captures = read_pictures(view, "captures", {view, root}, manifest.parent_path());
    return ball;
}

/// Of a view, or of the manifest where it has one view.
const std::initializer_list<std::string_view> kViewFields{"camera",
                                                          "captures",
                                                          "sphere",
                                                          "outline_px",
                                                          "fit_outline",
                                                          "mask",
                                                          "camera_deg",
                                                          "exposure_s",
                                                          "transfer",
                                                          "black_level",
                                                          "saturates_at",
                                                          "raw_half"};

void read_views(const JsonReader& root, const Json& json, EnvironmentFolder& result) {
    root.allow_only(
        {"format_version", "environment", "camera_to_xyz", "reflectance", "fresnel", "views"},
        kViewFields);
    if (root.has("reflectance")) {
        result.reflectance = read_share(root["reflectance"], kDarkestBall);
    }
    if (root.has("fresnel")) result.fresnel = root["fresnel"].boolean();
    if (!root.has("views")) {
        result.views.push_back(read_view(root, root, json, result.manifest));
        return;
    }
    const auto views = root["views"];
    for (const char* name : {"camera", "captures", "outline_px", "mask"}) {
        if (root.has(name)) {
            root[name].fail("beside views", "views that each say their own");
        }
    }
    if (views.size() == 0 || views.size() > kMostViews) {
        views.fail(std::to_string(views.size()) + " views",
                   "1 to " + std::to_string(kMostViews) + " cameras' photographs");
    }
    for (std::size_t k = 0; k < views.size(); ++k) {
        const auto view = views.at(k);
        view.allow_only(kViewFields);
        result.views.push_back(read_view(view, root, json["views"][k], result.manifest));
    }
}

void read_panorama(const JsonReader& root, EnvironmentFolder& result) {
    root.allow_only({"format_version",
                     "environment",
                     "camera_to_xyz",
                     "captures",
                     "mask",
                     "yaw_deg",
                     "pitch_deg",
                     "roll_deg",
                     "marks",
                     "exposure_s",
                     "transfer",
                     "black_level",
                     "saturates_at",
                     "raw_half"});
    PanoramaPictures& panorama = result.panorama;
    const auto folder = result.manifest.parent_path();
    panorama.mask = read_mask(root, folder);
    const auto angle = [&](const char* name, double& value) {
        if (!root.has(name)) return false;
        value = root[name].number_between(-360.0, 360.0);
        return true;
    };
    bool turned = angle("yaw_deg", panorama.yaw_deg);
    turned = angle("pitch_deg", panorama.pitch_deg) || turned;
    turned = angle("roll_deg", panorama.roll_deg) || turned;
    if (root.has("marks")) {
        const auto marks = root["marks"];
        if (turned) marks.fail("marks and angles", "one of them");
        if (marks.size() != 2) marks.fail(std::to_string(marks.size()) + " marks", "two marks");
        panorama.marks.emplace();
        for (std::size_t k = 0; k < 2; ++k) {
            const auto mark = marks.at(k);
            mark.allow_only({"pixel", "direction"});
            DirectionMark& read = (*panorama.marks)[k];
            read.pixel = read_pixel(mark["pixel"]);
            read.direction = vec3_within(mark["direction"], kLongestDirection);
            if (!(glm::length(read.direction) > 1e-9)) {
                mark["direction"].fail("no length", "a direction [x, y, z]");
            }
        }
    }
    panorama.captures = read_pictures(root, "captures", {root}, folder);
}

}  // namespace

bool is_environment_manifest(const std::filesystem::path& manifest) {
    return read_json_file(manifest).contains("environment");
}

EnvironmentFolder read_environment_folder(const std::filesystem::path& folder) {
    const auto manifest = manifest_in(folder);
    EnvironmentFolder result = parse_environment_manifest(read_text_file(manifest), manifest);
    std::vector<Capture*> all;
    for (Capture& capture : result.panorama.captures) all.push_back(&capture);
    for (BallView& view : result.views) {
        for (Capture& capture : view.captures) all.push_back(&capture);
    }
    complete_exposures(all, manifest, PhotographUse::light);
    return result;
}

EnvironmentFolder parse_environment_manifest(const std::string& text,
                                             const std::filesystem::path& manifest) {
    const Json json = parse_json(text, manifest);
    const JsonReader root(manifest, json);
    if (root.has("format_version")) root.require_format_version(kNewestEnvironmentVersion);
    EnvironmentFolder result;
    result.manifest = manifest;
    if (root["environment"].one_of({"ball", "panorama"}) == 0) {
        read_views(root, json, result);
    } else {
        read_panorama(root, result);
    }
    if (root.has("camera_to_xyz")) {
        result.camera_to_xyz = manifest.parent_path() / root["camera_to_xyz"].text();
    }
    return result;
}

std::vector<Capture> photographs_of(const EnvironmentFolder& folder) {
    std::vector<Capture> captures = folder.panorama.captures;
    for (const BallView& view : folder.views) {
        captures.insert(captures.end(), view.captures.begin(), view.captures.end());
    }
    return captures;
}

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
