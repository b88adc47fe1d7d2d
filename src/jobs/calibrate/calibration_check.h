// Whether a calibration shows what is wanted: corrected colours, photographed.
#pragma once

#include <string>
#include <vector>

#include "calibration/correspondence/gray_code.h"
#include "core/bench_ports.h"
#include "core/grade.h"
#include "core/progress.h"
#include "jobs/comparison.h"
#include "scene/colour_calibration.h"

namespace livery {

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
