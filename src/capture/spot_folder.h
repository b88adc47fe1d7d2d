// A folder of photographs of a narrow spot of light on a translucent sample and on a white one
// (docs/measuring.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "capture/captures_folder.h"

namespace livery {

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
