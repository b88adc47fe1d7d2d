// What the calibration panel remembers between frames.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/grade.h"
#include "studio/kit/widgets.h"

struct ImVec4;

namespace livery {

struct Studio;

struct CalibrationPanelState {
    std::vector<std::filesystem::path> kept;
    std::vector<std::string> benches;
    double listed_at_s = -1.0;
    Held<double> held_percentile;
    std::string list_problem;
    std::filesystem::path taken;  ///< the finished calibration that was put to use
    bool dismissed = false;       ///< the refusal was read
    bool starts_after_first_frame = false, started_by_itself = false;  ///< the one under way
    /// What no longer fits the calibration in use, and for which set-up, product and projector that
    /// was found out.
    std::vector<std::string> stale;
    std::shared_ptr<const void> stale_setup, stale_product;
    std::string stale_projector;
};

const ImVec4& colour_of(Grade grade);
/// A row a figure, its grade at the right; what it means and what helps while the pointer is on it.
void draw_figures(const std::vector<GradedFigure>& figures);
/// Puts a calibration's folder to use; asks for its projector where it does not say.
void load_calibration(Studio& studio, const std::filesystem::path& folder);
void draw_calibration_panel(Studio& studio);

}  // namespace livery
