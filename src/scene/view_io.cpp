#include "core/json.h"
#include "core/paths.h"
#include "scene/pose_io.h"
#include "scene/view.h"

namespace livery {

namespace {

constexpr int kViewVersion = 1;
constexpr int kLargestSide = 65536;

}  // namespace

View read_camera_fields(const JsonReader& object) {
    View view;
    view.width = object["width"].integer(1, kLargestSide);
    view.height = object["height"].integer(1, kLargestSide);
    read_lens(object, view);
    view.view_from_world = read_pose(object);
    return view;
}

Json json_of(const View& view) {
    const glm::dvec2 principal = view.principal_px - 0.5;
    Json json;
    json["width"] = view.width;
    json["height"] = view.height;
    json["matrix"] = {
        view.focal_px.x, 0.0, principal.x, 0.0, view.focal_px.y, principal.y, 0.0, 0.0, 1.0};
    json["distortion"] = view.distortion;
    json["rotation"] = json_from(view.view_from_world.rotation);
    json["translation_mm"] = json_from(view.view_from_world.translation);
    return json;
}

View read_camera_file(const std::filesystem::path& file) {
    return parse_camera(read_text_file(file), file);
}

View parse_camera(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    // The bare OpenCV form of other programs has no version; ours always writes one.
    if (root.has("format_version")) root.require_format_version(kViewVersion);
    root.allow_only({"format_version",
                     "name",
                     "width",
                     "height",
                     "matrix",
                     "distortion",
                     "rotation",
                     "translation_mm"});
    return read_camera_fields(root);
}

void write_camera_file(const std::filesystem::path& file, const View& view) {
    Json json = {{"format_version", kViewVersion}};
    json.update(json_of(view));
    write_json_file(file, json);
}

}  // namespace livery
