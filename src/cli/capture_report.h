// What a capture made, for the terminal and for scripts.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "core/grade.h"
#include "jobs/calibrate/staged_calibration.h"

namespace livery {

Json json_of(const GradedFigure& figure);
Json json_of(const std::vector<GradedFigure>& figures);
/// A line with its grade first, and what helps below it.
std::string line_of(const GradedFigure& figure);

/// Figures and words of what was found; what was calibrated goes to `calibration` (a folder; empty:
/// nowhere). Throws FileError.
void report_calibration(const StagedCalibration& run,
                        const std::string& calibration,
                        Outcome& outcome);
/// The same of the check.
void report_check(const CalibrationCheck& check, Outcome& outcome);

}  // namespace livery
