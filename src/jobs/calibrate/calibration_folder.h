// A calibration's folder with its projector: what render, the desktop and the vote open.
#pragma once

#include <filesystem>
#include <optional>

#include "scene/colour_calibration.h"
#include "scene/view.h"

namespace livery {

/// `calibration.json` with its pictures, and `projector.json`, the view of the projector that it is
/// of; the folder is replaced whole or not. Throws FileError, and as check_projector().
void write_setup(const std::filesystem::path& folder,
                 const ColourCalibration& calibration,
                 const View& projector);

/// The folder's `projector.json`, if it is there. Throws FileError when it is not a camera file.
std::optional<View> projector_view_of(const std::filesystem::path& calibration_folder);

/// Writes the view in a camera file as the `projector.json` of a calibration that has none. Throws
/// FileError, and when the two have other sizes.
void add_projector(const std::filesystem::path& calibration_folder,
                   const std::filesystem::path& camera_file);

/// Throws FileError of `camera_file` when the view has other pixels than the calibration.
void check_projector(const View& view,
                     const std::filesystem::path& camera_file,
                     int calibration_width,
                     int calibration_height);

}  // namespace livery
