// What the calibration panel remembers between frames.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studio/kit/held.h"

namespace livery {

struct CalibrationPanelState {
    std::vector<std::filesystem::path> kept;
    std::vector<std::string> benches;
    double listed_at_s = -1.0;
    Held<double> held_percentile;
    std::string list_problem;
    std::filesystem::path taken;  ///< the finished calibration that was put to use
    bool dismissed = false;       ///< the refusal was read
};

}  // namespace livery
