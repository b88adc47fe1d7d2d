// Lenses of camera and projector and how they stand to each other, from files: what `livery
// calibrate geometry` does.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "calibration/geometry/board_sight.h"
#include "calibration/registration/pixel_refinement.h"
#include "core/json.h"
#include "core/progress.h"
#include "scene/data_sheet.h"
#include "scene/view.h"

namespace livery {

struct PairGeometryRequest {
    std::vector<std::filesystem::path> captures;  ///< Gray code, a folder a pose of the board
    std::filesystem::path patterns_manifest;      ///< for folders without a manifest of their own
    glm::ivec2 projector_px{0};
    Board board;  ///< unless there are data sheets
    /// Without a board: one folder, of anything that is not a plane.
    std::optional<DataSheets> data_sheets;
    /// With a board: what a tape says of the distance between the lenses; 0: not measured.
    double lens_distance_mm = 0.0;
    /// White - black and stripes - inverse that a pixel must show at least, of the range between
    /// the two in the file's units; negative: from the noise, and none.
    double black_threshold = -1.0, white_threshold = -1.0;
};

/// One folder, and what became of it.
struct BoardPose {
    std::string folder;
    bool used = false;
    std::string reason;       ///< why not
    std::size_t corners = 0;  ///< carried to the projector
    double edge_px = 0.0;     ///< width of its squares' edges in the camera (SightSearch)
    double moved_px = 0.0;    ///< between the photographs, in the camera (SightSearch)
    double rms_px = 0.0;      ///< foretold by the others, in the projector
};

struct PairGeometry {
    View camera;     ///< the world is its frame
    View projector;  ///< view_from_world is projector_from_camera
    bool from_boards = false;
    /// From boards; else 0.
    double camera_rms_px = 0.0, projector_rms_px = 0.0, held_out_rms_px = 0.0;
    double stereo_rms_px = 0.0;  ///< of both together; without boards the median distance of rays
    std::array<double, 4> camera_standard_error_px{}, projector_standard_error_px{};
    std::array<double, 3> turn_standard_error_rad{}, shift_standard_error_mm{};  ///< PairSolution
    PairInformation information{};                                               ///< PairSolution
    std::vector<BoardPose> poses;
    std::vector<std::string> warnings;
};

/// Throws Refused (too few poses, boards all parallel, no board found), FileError,
/// std::invalid_argument.
PairGeometry find_pair_geometry(const PairGeometryRequest& request, const Progress& progress = {});

/// Every figure, with the names of docs/commands.md; pixel centres at integers, as OpenCV's.
Json figures_of(const PairGeometry& geometry);

/// Writes `geometry.json`, `camera.json` and `projector.json`.
void write_pair_geometry(const std::filesystem::path& folder, const PairGeometry& geometry);

/// How well the calibrations in these folders, one a sight or one for all, are known: boards' own
/// information from each `geometry.json`; where one has none, as boards or data sheets leave it.
/// Throws FileError.
LensPrior lens_prior_of(const std::vector<std::filesystem::path>& folders);
/// Parses and checks the text of a `geometry.json` for the same. Throws FileError.
LensPrior parse_lens_prior(const std::string& text, const std::filesystem::path& file);
/// Checks a `geometry.json`. Throws FileError.
void check_geometry_file(const std::filesystem::path& file);

}  // namespace livery
