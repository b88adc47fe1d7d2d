// What a calibration is asked for: one value all the way from whoever asks to the colours' fit.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "scene/data_sheet.h"
#include "scene/product.h"
#include "scene/view.h"

namespace livery {

enum class ColourMode { paper, robust };

struct CameraToXyz {
    glm::dmat3 xyz_from_camera{1.0};
    /// "primaries", "chart", "matrix"; empty: camera RGB taken as linear Rec.709
    std::string origin;
    /// XYZ of the full primaries (columns, black not subtracted) and of black, measured with a
    /// colorimeter; the matrix is then solved from the mixing that the camera saw. With
    /// `measured_at_px` (projector pixel on the mock-up) the scale is absolute, XYZ at the eye;
    /// without it they were taken off a white reference elsewhere and the scale is relative.
    bool has_primaries = false;
    glm::dmat3 primaries_xyz{0.0};
    glm::dvec3 black_xyz{0.0};
    /// Full white, black not subtracted; for non-additive projectors.
    std::optional<glm::dvec3> white_xyz;
    std::optional<glm::dvec2> measured_at_px;
};

struct CalibrationSettings {
    std::string made_with;      ///< projector and camera, in words
    int width = 0, height = 0;  ///< projector pixels

    // What is shown
    int shots = 2;  ///< photographs a colour picture, of a camera that takes as many as asked for
    PlaceCode places = PlaceCode::gray;  ///< what is shown to find where the camera sees pixels
    /// Where the camera sees the projector's pixels, where that is known: no Gray code is shown.
    std::optional<ProjectorToCamera> map;
    /// Pictures for the colours: the six roles and those mosaics that are wanted. Empty: the six
    /// for this size, and mosaics where white turns out not to be the sum of its channels.
    std::vector<Pattern> patterns;
    int dark_drive = 0, bright_drive = 255;

    // How the colours are fitted
    ColourMode mode = ColourMode::robust;
    double kernel_bandwidth = 0.02;  ///< of N, for Nadaraya-Watson (paper mode)
    CameraToXyz camera_to_xyz;

    // Where everything stands
    /// The projector, and the mock-up: it alone is then lit, and the colorimeter is held to it.
    std::optional<View> projector;
    std::shared_ptr<const Product> product;
    /// Where the projector is not known to stand, but its lens and the camera's are: the Gray code
    /// is photographed first and tells, with the mock-up's mesh (find_room).
    std::optional<DataSheets> data_sheets;
    std::optional<View> turned_as;  ///< how a sphere is turned, which its photographs do not tell
    /// What is lit for the colours, one channel, non-zero: lit; empty: mockup_mask() of projector
    /// and product, or, without these, everything.
    Image8 mockup;
    /// Irradiance of each projector pixel's surface by the pose (predict_hidden): what the camera
    /// does not see is predicted. Empty: it stays black.
    ImageF irradiance;
    std::vector<std::string> warnings;  ///< of photographs that were taken before
};

/// The `--camera-to-xyz` file: a matrix, or the measured primaries (docs/files.md). Throws
/// FileError, also for a matrix or primaries that are singular.
CameraToXyz read_camera_to_xyz(const std::filesystem::path& file);
/// The same of its text.
CameraToXyz parse_camera_to_xyz(const std::string& text, const std::filesystem::path& file);

/// What photographs without a projector are read with: a file's matrix; of no file, camera RGB as
/// linear Rec.709, labelled so. Throws FileError, also for a projector's primaries.
CameraToXyz camera_matrix(const std::filesystem::path& file);

/// Projector pixels that are lit for the colours; empty: all.
Image8 mockup_of(const CalibrationSettings& settings);

}  // namespace livery
