// Colour photographs -> compensation (equations 3 to 9 of the paper, and the robust variant).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "calibration/correspondence/fringes.h"
#include "calibration/correspondence/gray_code.h"
#include "calibration/correspondence/patterns.h"
#include "core/progress.h"
#include "scene/colour_calibration.h"

namespace livery {

enum class ColourMode { paper, robust };

struct CameraToXyz {
    glm::dmat3 xyz_from_camera{1.0};
    std::string
        origin;  ///< "primaries", "chart", "matrix"; empty: camera RGB taken as linear Rec.709
    /// XYZ of the full primaries (columns, black not subtracted) and of black, measured with a
    /// colorimeter; the matrix is then solved from the mixing that the camera saw. With
    /// `measured_at_px` (projector pixel on the mock-up) the scale is absolute, XYZ at the eye;
    /// without it they were taken off a white reference elsewhere and the scale is relative.
    bool has_primaries = false;
    glm::dmat3 primaries_xyz{0.0};
    glm::dvec3 black_xyz{0.0};
    std::optional<glm::dvec3>
        white_xyz;  ///< full white, black not subtracted; for non-additive projectors
    std::optional<glm::dvec2> measured_at_px;
};

struct ColourOptions {
    ColourMode mode = ColourMode::robust;
    int dark_drive = 0, bright_drive = 255;
    double kernel_bandwidth = 0.02;  ///< of N, for Nadaraya-Watson (paper mode)
    CameraToXyz camera_to_xyz;
    std::string made_with;
};

/// `captures` holds the six roles, more than one photograph a role is averaged, and `colors-N`
/// mosaics where the projector is not additive (`patterns` says what each showed: gray-levels and
/// the mosaics are needed there). Throws Refused with why and fix, FileError for captures that do
/// not fit together, std::invalid_argument for options and patterns that make no sense.
ColourCalibration calibrate_colour(const std::vector<RoledPhotograph>& captures,
                                   const std::vector<Pattern>& patterns,
                                   const ProjectorToCamera& map,
                                   const ColourOptions& options,
                                   const Progress& progress = {});

/// Projects, photographs and solves, all through the three ports.
struct LiveOptions {
    int width = 0, height = 0;  ///< projector pixels
    ColourOptions colour;
    int shots = 1;  ///< photographs a colour picture, of a camera that takes as many as asked for
    /// Pictures for the colours: the six roles and those mosaics that are wanted. Empty: the six
    /// for this size, and mosaics where white turns out not to be the sum of its channels.
    std::vector<Pattern> patterns;
    /// What is shown to find places.
    PlaceCode places = PlaceCode::gray;
    /// Where it is known already no Gray code is asked for.
    std::optional<ProjectorToCamera> map;
    /// Projector pixels that the mock-up itself takes, where its pose is known (non-zero: mock-up;
    /// empty: not known). These alone are lit, and the colorimeter is held to them.
    Image8 mockup;
};
struct LiveResult {
    ColourCalibration calibration;
    ProjectorToCamera map;
    /// The colour ones, a steady change of the lamp taken out, for a second look with other
    /// options.
    std::vector<RoledPhotograph> captures;
    std::vector<Pattern> patterns;
    /// Photographs that it was made of, of those that were recorded: role and file of each.
    std::vector<std::pair<std::string, std::string>> kept;
    /// The last photographs of white and of black, to tell later whether something has changed;
    /// empty: the photographs were taken before.
    Photograph white, black;
    double capture_seconds = 0.0, solve_seconds = 0.0;
    /// Of capture_seconds, within the camera's and the projector's ports; 0: nobody looked.
    double camera_seconds = 0.0, projector_seconds = 0.0;
    int colour_photographs = 0, latency_photographs = 0;
};
/// Whether the photographs are taken now (their latency and exposure are found first, what fails is
/// repeated, a colorimeter reads what is shown) or are what they are (`BenchPorts::turn_to`), the
/// same pictures are asked for, and the photographs are judged and solved the same way. Throws
/// Refused, FileError, std::invalid_argument.
LiveResult calibrate_live(const BenchPorts& bench,
                          const LiveOptions& options,
                          const Progress& progress = {});

/// Where the camera sees each projector pixel, photographed and judged as calibrate_live() does it.
struct LiveMap {
    ProjectorToCamera map;
    Photograph white, black;  ///< empty: the photographs were taken before
    int camera_width = 0, camera_height = 0;
    std::vector<std::string> warnings;
    /// Photographs that it was made of, of those that were recorded: role and file of each.
    std::vector<std::pair<std::string, std::string>> kept;
    double capture_seconds = 0.0;
};
/// Gray code, and fringes with `options.places`, alone: for whoever must know where things stand
/// before colours are photographed: `options.map`, `patterns` and `shots` are not looked at. Throws
/// as calibrate_live().
LiveMap photograph_map(const BenchPorts& bench,
                       const LiveOptions& options,
                       const Progress& progress = {});

/// Camera matrix from a colour chart lit by the projector's white (its colours' XYZ under that
/// light must be known) or, as most do, under daylight: for comparison. Least squares of relative
/// errors.
glm::dmat3 fit_camera_matrix(const std::vector<glm::dvec3>& camera_rgb,
                             const std::vector<glm::dvec3>& xyz);

/// Additivity error over which the additive model is warned about, and refused.
inline constexpr double kAdditivityWarning = 0.02, kAdditivityLimit = 0.05;

}  // namespace livery
