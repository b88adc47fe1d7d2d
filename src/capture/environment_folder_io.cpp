#include <glm/geometric.hpp>

#include "capture/environment_folder.h"
#include "capture/exposures.h"
#include "capture/manifest_io.h"
#include "capture/sphere_fields.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

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

}  // namespace livery
