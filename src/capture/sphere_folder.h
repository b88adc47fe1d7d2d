// A folder of photographs of a painted sphere, one light at a time, and of a white one
// (docs/measuring.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "capture/captures_folder.h"

namespace livery {

struct SphereCapture {
    Capture photograph;
    /// Only a white sphere's may be missing: its shading tells which of the folder's lights shone.
    std::optional<glm::dvec3> light_position_mm;
};

struct SpherePlace {
    glm::dvec3 centre_mm{0.0};
    double diameter_mm = 0.0;
};

struct SphereFolder {
    std::filesystem::path manifest;
    std::string camera;         ///< a camera file's text
    std::string camera_origin;  ///< what it was read from, for messages
    SpherePlace sphere;
    std::vector<SphereCapture> captures;
    std::vector<SphereCapture> white;
    std::optional<SpherePlace> white_sphere;  ///< where it stood, if not where the painted one did
    glm::dvec3 white_reflectance{1.0};        ///< of red, green, blue
    std::filesystem::path camera_to_xyz;      ///< empty: not named
};

/// Whether a manifest.json is one of a painted sphere. Throws FileError.
bool is_sphere_manifest(const std::filesystem::path& manifest);

/// Reads a folder's manifest.json; every photograph named must exist.
/// Throws FileError, and as complete_exposures().
SphereFolder read_sphere_folder(const std::filesystem::path& folder);
/// The same of the manifest's text; what it names lies beside it.
SphereFolder parse_sphere_manifest(const std::string& text, const std::filesystem::path& manifest);

}  // namespace livery
