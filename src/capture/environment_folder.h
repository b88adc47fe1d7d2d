// A folder of photographs of the light all around: of a mirror ball, or a panorama
// (docs/measuring.md).
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "capture/captures_folder.h"

namespace livery {

/// A mirror ball as one camera sees it.
struct BallView {
    std::string field;          ///< where the manifest says so: "views[1]."; empty: at its top
    std::string camera;         ///< a camera file's text
    std::string camera_origin;  ///< what it was read from, for messages
    std::optional<glm::dvec3> centre_mm;
    double diameter_mm = 0.0;
    std::vector<glm::dvec2> outline_px;  ///< pixel centres at half integers
    bool fit_outline = true;             ///< to steps of brightness in the picture
    std::filesystem::path mask;          ///< what does not count; empty: all does
    double camera_deg = 0.0;             ///< left out around the camera, seen from the ball
    std::vector<Capture> captures;
};

/// Something seen in a panorama, and which way it lies.
struct DirectionMark {
    glm::dvec2 pixel{0.0};      ///< centres at half integers
    glm::dvec3 direction{0.0};  ///< in the world, of any length but none
};

struct PanoramaPictures {
    std::vector<Capture> captures;
    std::filesystem::path mask;
    double yaw_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
    std::optional<std::array<DirectionMark, 2>> marks;  ///< instead of the angles
};

struct EnvironmentFolder {
    std::filesystem::path manifest;
    std::vector<BallView> views;  ///< of the ball; empty: a panorama
    glm::dvec3 reflectance{1.0};  ///< the ball's, RGB
    bool fresnel = true;          ///< it grows toward grazing incidence
    PanoramaPictures panorama;
    std::filesystem::path camera_to_xyz;  ///< empty: not named
};

/// Whether a manifest.json is one of light all around. Throws FileError.
bool is_environment_manifest(const std::filesystem::path& manifest);

/// Reads a folder's manifest.json; every photograph and mask named must exist.
/// Throws FileError, and as complete_exposures().
EnvironmentFolder read_environment_folder(const std::filesystem::path& folder);
/// The same of the manifest's text; what it names lies beside it.
EnvironmentFolder parse_environment_manifest(const std::string& text,
                                             const std::filesystem::path& manifest);

/// Every photograph that it names.
std::vector<Capture> photographs_of(const EnvironmentFolder& folder);

}  // namespace livery
