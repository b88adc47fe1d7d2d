// How good a calibration is: its own figures on the scale of docs/calibration.md, whether it shows
// what is wanted (corrected colours, photographed), and how far two calibrations are apart.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calibration/correspondence/gray_code.h"
#include "core/bench_ports.h"
#include "core/grade.h"
#include "core/progress.h"
#include "jobs/comparison.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/view.h"

namespace livery {

/// What it was made with, its residuals and its warnings, each with its name.
std::vector<std::pair<std::string, std::string>> calibration_figures(const ColourCalibration& c);

/// One a figure, in the order of the docs' table. Figures that are not finite are bad.
std::vector<GradedFigure> grade_figures(const ColourCalibration& calibration);

struct CalibrationDifference {
    /// What the older one's drives show if the newer one is right, against what is wanted: muted
    /// colours within reach of both, over the pixels that both measured. No pixels: one of them is
    /// of a projector that is not additive, which is not compared.
    ErrorStatistics de00;
    ErrorStatistics moved_px;  ///< how far their pictures of the mesh are apart, projector pixels
    double brightness = 1.0;   ///< design white of the newer over the older's
    double valid_then = 0.0, valid_now = 0.0;  ///< share of the mock-up's pixels with a correction
};

/// Both for a projector of one size. Throws std::invalid_argument when they are not, Refused when
/// nothing of the mesh is valid in one of them.
CalibrationDifference compare_calibrations(const ColourCalibration& then,
                                           const View& projector_then,
                                           const ColourCalibration& now,
                                           const View& projector_now,
                                           const Mesh& mesh);

/// The difference in figures, for people.
std::vector<GradedFigure> grade_figures(const CalibrationDifference& difference);

/// Uniform colours that a check shows: within reach of nearly every pixel when scaled by the design
/// white that all but kOutOfReach_percent of the pixels can show.
struct MutedColour {
    const char* name;
    glm::dvec3 working;  ///< linear Rec.709, 1: design white
};
inline constexpr double kOutOfReach_percent = 2.0;
inline constexpr MutedColour kMutedColours[] = {{"grey", {0.4, 0.4, 0.4}},
                                                {"muted red", {0.35, 0.18, 0.15}},
                                                {"muted green", {0.17, 0.32, 0.18}},
                                                {"muted blue", {0.15, 0.2, 0.36}}};
/// One of them all over the mock-up, with coverage.
ImageF uniform_picture(const MutedColour& colour, const Image8& mockup);

/// One uniform colour that was wanted all over the mock-up.
struct CheckedColour {
    std::string role;         ///< "verify-0"
    std::string name;         ///< "grey", for people
    ErrorStatistics de00;     ///< as the camera sees blocks of it, against the one wanted
    Image8 drive;             ///< what was shown
    Photograph photograph{};  ///< what was seen
};

struct CalibrationCheck {
    std::vector<CheckedColour> colours;
    ErrorStatistics de00;  ///< all of them together
    double capture_seconds = 0.0;
};

/// Colours that nothing was fitted to (a grey and three muted ones, within reach of 98% of the
/// pixels), corrected, shown and photographed at the exposure of `white`, and compared as means
/// over 4 x 4 projector pixels. Seen colours are the camera's through the calibration's matrix, so
/// what that matrix is off by does not show. `mockup`: one channel, non-zero counts. `late`:
/// photographs until a picture is there. Throws Refused when too few pixels can be compared, and as
/// the ports.
CalibrationCheck check_calibration(const BenchPorts& ports,
                                   const ColourCalibration& calibration,
                                   const ProjectorToCamera& map,
                                   const Image8& mockup,
                                   const Photograph& white,
                                   int late,
                                   const Progress& progress = {});

/// The check in figures.
std::vector<GradedFigure> grade_figures(const CalibrationCheck& check);

}  // namespace livery
