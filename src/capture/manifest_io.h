// The JSON files of a captures folder. For the sources of this folder alone.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "capture/captures_folder.h"
#include "capture/patterns_folder.h"
#include "capture/stand_folders.h"
#include "core/json.h"

namespace livery {

/// Reads a captures folder's manifest.json; every photograph named must exist. An exposure that it
/// does not state is 0. Throws FileError.
CapturesFolder read_captures_manifest(const std::filesystem::path& manifest);

/// Writes a manifest whose exposures are still to be filled in. Throws FileError.
void write_patterns_manifest(const std::filesystem::path& manifest,
                             const PatternsManifest& patterns);

/// Writes the folder's manifest.json; photographs are named relative to it. Throws FileError.
void write_captures_manifest(const CapturesFolder& folder);

/// A camera's response: linear light for equally spaced file values from 0 to full scale, both as
/// fractions of full scale; never falls. Throws FileError.
std::vector<double> read_response(const std::filesystem::path& file);

/// Refuses fields that no entry of `captures` has. Throws FileError.
void allow_capture_fields(const JsonReader& entry);
/// The photograph that an entry names, which must be there. Throws FileError.
std::filesystem::path read_photograph_name(const JsonReader& entry,
                                           const std::filesystem::path& folder);
/// Exposure, transfer, black level and saturation, each from the first of the places that has it;
/// an exposure that none has is 0, for complete_exposures(). Throws FileError.
void read_settings(const std::vector<JsonReader>& places,
                   const std::filesystem::path& folder,
                   Capture& capture);

/// The photographs of one scene that `owner` lists as `name`, each with its settings from its
/// entry, else from the first of `places` that has them. Throws FileError, also for an empty list.
std::vector<Capture> read_pictures(const JsonReader& owner,
                                   std::string_view name,
                                   const std::vector<JsonReader>& places,
                                   const std::filesystem::path& folder);

/// The same of their texts; what they name lies beside the file.
CapturesFolder parse_captures_manifest(const std::string& text,
                                       const std::filesystem::path& manifest);
PatternsManifest parse_patterns_manifest(const std::string& text,
                                         const std::filesystem::path& manifest);
std::vector<double> parse_response(const std::string& text, const std::filesystem::path& file);

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
