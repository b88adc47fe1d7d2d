// Folders of photographs of a stand: of a painted sphere, one light at a time, and of a white one;
// of the light all around, by a mirror ball or a panorama; of a narrow spot of light on a
// translucent sample and on a white one.
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

/// One surface, with the spot on it and with the projector showing black, by one camera that stands
/// still.
struct SpotPictures {
    std::vector<Capture> lit, black;
};

/// A camera of known pose, and where the surfaces and the projector are in its world.
struct SpotPlaces {
    std::string camera;         ///< a camera file's text
    std::string camera_origin;  ///< what it was read from, for messages
    glm::dvec3 point_mm{0.0};   ///< of the plane of both surfaces
    glm::dvec3 normal{0.0};     ///< of that plane, of unit length, either way
    glm::dvec3 projector_mm{0.0};
};

/// A camera that looks along the surfaces' normal from afar.
struct SpotScale {
    double mm_per_px = 0.0;
    double incidence_deg = 0.0;  ///< of the projector's light, from the normal
};

struct SpotFolder {
    std::filesystem::path manifest;
    std::optional<SpotPlaces> places;  ///< one of these two
    std::optional<SpotScale> scale;
    SpotPictures sample, white;
    glm::dvec3 white_reflectance{1.0};  ///< of red, green, blue
};

/// Whether a manifest.json is one of a spot of light. Throws FileError.
bool is_spot_manifest(const std::filesystem::path& manifest);

/// Reads a folder's manifest.json; every photograph named must exist.
/// Throws FileError, and as complete_exposures().
SpotFolder read_spot_folder(const std::filesystem::path& folder);
/// The same of the manifest's text; what it names lies beside it.
SpotFolder parse_spot_manifest(const std::string& text, const std::filesystem::path& manifest);

/// Every photograph that it names.
std::vector<Capture> photographs_of(const SpotFolder& folder);

}  // namespace livery
