// A calibration's folder with its projector, what it was made for and with: what render, the
// desktop and the vote open, and by which one that no longer fits is told.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/drift.h"
#include "core/grade.h"
#include "jobs/calibrate/bench_calibration.h"
#include "scene/colour_calibration.h"
#include "scene/product.h"
#include "scene/room.h"
#include "scene/view.h"

namespace livery {

inline constexpr int kOriginVersion = 1;  ///< of the format

struct CalibrationOrigin {
    std::string product;                 ///< its name
    std::string shape;                   ///< shape_hash() of the mock-up's mesh
    std::string made_with;               ///< camera and projector, in words
    std::optional<RoomGeometry> room;    ///< as found; nothing: the pose was given
    std::optional<DriftReference> ends;  ///< nothing: the photographs were taken before
    /// Where the camera saw the projector's pixels off the mock-up (2 channels, NaN: unknown);
    /// empty: nobody knows.
    ImageF around;
    std::string reposed_from;  ///< id of the calibration that it was made of; empty: of photographs
    double capture_seconds = 0.0, solve_seconds = 0.0;
};

/// Of a calibration that was just made.
CalibrationOrigin origin_of(const CalibrationResult& made, const CalibrationSettings& settings);

/// Of one for a product, of whose making nothing else is known.
CalibrationOrigin origin_for(const Product& product, const std::string& made_with);

/// `origin.json`, with `white.exr` and `black.exr` (mean of the channels, linear per second) where
/// there are photographs of the end, `around.exr` where that is known, and `room.json`. Throws
/// FileError.
void write_origin(const std::filesystem::path& folder, const CalibrationOrigin& origin);
/// Nothing: the folder has none. `with_photographs`: those of the end, which take longer to read.
/// Throws FileError.
std::optional<CalibrationOrigin> read_origin(const std::filesystem::path& folder,
                                             bool with_photographs = true);
/// The same without the photographs, of its text.
CalibrationOrigin parse_origin(const std::string& text, const std::filesystem::path& file);

/// Why it cannot be that product's: another name and another mesh. Empty: it may be.
std::string another_product(const CalibrationOrigin& origin, const Product& product);

/// What is no longer as it was, each with the way out, a sentence; empty: nothing that can be told
/// without a photograph. `projector`: its name and pixels in words, empty: not known.
std::vector<std::string> what_changed(const CalibrationOrigin& origin,
                                      const Product& product,
                                      const std::string& projector);

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
