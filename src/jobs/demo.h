// `livery demo`: a whole session on the simulated bench, from photographs to the report.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/progress.h"
#include "gl/context.h"
#include "jobs/calibrate/room_pose.h"
#include "jobs/comparison.h"
#include "scene/colour_calibration.h"
#include "scene/gamut_mapping.h"
#include "twin/description.h"

namespace livery {

struct DemoOptions {
    std::filesystem::path out;  ///< created
    std::string bench = "default";
    std::string product = "car";  ///< or "player", or "sphere": the paper's Fig. 10
    glm::ivec2 size_px{0};        ///< projector resolution; 0: as the bench file says
    GlDevice gl_device = GlDevice::automatic;
    std::uint64_t seed = 1;
    double design_white_percentile = kDesignWhitePercentile;
};

/// A look compared with what was shown of it. `uncorrected`: the wanted picture sRGB-encoded to 8
/// bit, same white.
struct JudgedPictures {
    Comparison corrected;
    Comparison uncorrected;
    std::optional<Comparison> chart_corrected;  ///< camera matrix from a chart under daylight
};

/// One look or paint: what was wanted, and what the simulated audience saw.
struct DesignResult {
    std::string name;
    JudgedPictures seen;  ///< in the eye's picture, wherever on the mock-up the light falls
    /// At each projector pixel by itself, on the place that it lights: the correction alone, with
    /// no error of pose or lens in it.
    JudgedPictures pixels;
    double unlit_fraction = 0.0;         ///< of the mock-up that the eye sees: no light reaches it
    double out_of_gamut_fraction = 0.0;  ///< of the valid pixels, as compensation saw it
    double shade_ms = 0.0, compensate_ms = 0.0;
    std::map<std::string, std::filesystem::path> pictures;  ///< by what they show, relative to out
};

struct DemoResult {
    std::string bench_name, product_name, renderer;
    ColourCalibration calibration;  ///< planes dropped after writing: id, residuals, warnings
    std::optional<RoomPose> room;   ///< nothing: pose and lens were read from the bench file
    /// How far from its place the picture lands, projector pixels, by the bench's truth.
    ErrorStatistics picture_off_px;
    double design_white_y = 0.0;
    double covered_fraction = 0.0;  ///< of the projector's picture, lit mock-up
    int mockup_length_px = 0;
    std::vector<DesignResult> designs;
    std::vector<std::pair<std::string, double>> seconds;  ///< stages in order, "total" last
    std::filesystem::path report;
};

/// Calibrates from photographs, renders, compensates, projects, photographs, compares, reports.
DemoResult run_demo(const DemoOptions& options, const Progress& progress = {});

}  // namespace livery
