#include "capture/sphere_fields.h"

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"

namespace livery {

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
