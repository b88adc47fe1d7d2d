// Fields that manifests of spheres share: where one stands, and the camera that sees it. For the
// sources of this folder alone.
#pragma once

#include <filesystem>
#include <string>

#include "capture/sphere_folder.h"
#include "core/json.h"

namespace livery {

inline constexpr double kFarthestPlace_mm = 1e6;
inline constexpr double kSmallestSphere_mm = 0.1;

/// [x, y, z]. Throws FileError.
glm::dvec3 read_place_mm(const JsonReader& field);

/// `centre_mm` and `diameter_mm`. Throws FileError.
SpherePlace read_sphere_place(const JsonReader& sphere);

/// A share of the light, from `lowest` to 1, or [R, G, B] of them. Throws FileError.
glm::dvec3 read_share(const JsonReader& share, double lowest);

/// A folder's manifest.json. Throws FileError for what is no folder.
std::filesystem::path manifest_in(const std::filesystem::path& folder);

struct CameraText {
    std::string text;    ///< a camera file's
    std::string origin;  ///< what it was read from, for messages
};
/// The member `camera` of `owner`, whose JSON is `json`: a camera file's fields, or its name beside
/// the manifest. Throws FileError.
CameraText read_camera_text(const JsonReader& owner,
                            const Json& json,
                            const std::filesystem::path& manifest);

}  // namespace livery
