// The `--camera-to-xyz` file: a matrix, or the measured primaries (docs/files.md).
#pragma once

#include <filesystem>

#include "calibration/colour/colour.h"

namespace livery {

/// Throws FileError, also for a matrix or primaries that are singular.
CameraToXyz read_camera_to_xyz(const std::filesystem::path& file);
/// The same of its text.
CameraToXyz parse_camera_to_xyz(const std::string& text, const std::filesystem::path& file);

/// What is taken when no file was given: camera RGB as linear Rec.709, and labelled so.
CameraToXyz assumed_rec709();

/// What photographs without a projector are read with: a file's matrix; of no file,
/// assumed_rec709(). Throws FileError, also for a projector's primaries.
CameraToXyz camera_matrix(const std::filesystem::path& file);

}  // namespace livery
