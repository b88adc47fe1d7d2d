// Patterns as files: what `livery patterns` writes for a photographer or a renderer to show.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "core/progress.h"

namespace livery {

/// One picture to project.
struct PatternFile {
    std::string role;               ///< one of the known roles (is_known_role)
    Image8 drive;                   ///< RGB device values at the projector's resolution
    std::vector<int> drive_values;  ///< of a uniform picture: R, G, B; else empty
};

/// A pattern as a manifest names it.
struct PatternEntry {
    std::string file;  ///< relative to the manifest
    std::string role;
    std::vector<int> drive;  ///< of a uniform picture: R, G, B; else empty
};

/// A patterns' or captures' manifest, read for its patterns alone.
struct PatternsManifest {
    int projector_width = 0, projector_height = 0;
    std::vector<PatternEntry> patterns;
};

/// Whether `role` is one that calibration knows: gray-column-N[-inverse], gray-row-N[-inverse],
/// phase-column-N, phase-row-N, colors-N, verify-N, white, black, dark-gray, bright-gray, red,
/// green, blue, gray-levels, repose[-inverse].
bool is_known_role(std::string_view role);

/// Writes 000.png, 001.png, ... and a manifest.json that becomes a captures folder's manifest once
/// it names the photographs and, where their EXIF has none, every exposure_s. Throws FileError, and
/// std::invalid_argument for an unknown role or a picture that is not width x height RGB.
void write_patterns_folder(const std::filesystem::path& folder,
                           int width,
                           int height,
                           const std::vector<PatternFile>& patterns,
                           const Progress& progress = {});

/// Whether a manifest.json is as write_patterns_folder wrote it: no exposure, and each photograph
/// that it names is the pattern itself. Throws FileError.
bool is_patterns_manifest(const std::filesystem::path& manifest);

/// Reads what write_patterns_folder wrote. Throws FileError.
PatternsManifest read_patterns_manifest(const std::filesystem::path& manifest);

/// The picture in a pattern's file: device values, RGB, of a projector of that size. Throws
/// FileError for another size and for fewer than three channels.
Image8 read_pattern(const std::filesystem::path& file, int width, int height);

}  // namespace livery
