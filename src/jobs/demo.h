// `livery demo`: a whole session on the simulated bench, from photographs to the report.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "compensation/compensation.h"
#include "core/progress.h"
#include "gl/context.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/comparison.h"
#include "scene/colour_calibration.h"
#include "scene/gamut_mapping.h"
#include "twin/bench.h"
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

/// Seconds of each stage, in the order in which they were met; repeated stages add up.
class StageTimes {
  public:
    void add(const std::string& stage, double seconds);
    std::vector<std::pair<std::string, double>> all() const { return stages_; }

  private:
    std::vector<std::pair<std::string, double>> stages_;
};

/// Runs `work`, adds its seconds to `stage` and returns what it returns.
template <typename Work>
auto timed(StageTimes& times, const std::string& stage, Work&& work);

/// A bench, calibrated from its own photographs and ready to show pictures.
struct CalibratedBench {
    std::shared_ptr<const Product> product;
    std::unique_ptr<Bench> bench;
    View projector;                ///< where it was found to stand
    std::optional<RoomPose> room;  ///< how; nothing: read from the bench file
    ColourCalibration calibration;
    CompensationTable table;
    std::optional<CompensationTable> chart_table;  ///< the same photographs, camera matrix by chart
    Image8 valid;                                  ///< 255 where the calibration is valid
    Image8 predicted;                              ///< 255 where it is predicted, not measured
    double design_white_y = 0.0;
};

/// Traces the bench, finds from photographs where everything stands, calibrates through its three
/// ports, predicts from the pose what the camera did not see, and writes `out/calibration` with the
/// projector's view beside it.
CalibratedBench calibrate_bench(const DemoOptions& options,
                                const BenchDescription& description,
                                std::shared_ptr<const Product> product,
                                StageTimes& times,
                                const Progress& progress);

/// What a look should be: the picture to correct, and what it is judged against, the render itself
/// or a painted sample's truth.
struct WantedLook {
    ImageF working;  ///< projector pixels, 1 = design white
    ImageF xyz;      ///< of what each projector pixel lights, absolute
    ImageF eye_xyz;  ///< in the eye's picture (`Bench::eye()`)
};

/// Shows a wanted picture corrected and uncorrected, observes both, writes the pictures.
DesignResult judge_design(const std::string& name,
                          const WantedLook& wanted,
                          const CalibratedBench& calibrated,
                          const std::filesystem::path& out,
                          StageTimes& times);

template <typename Work>
auto timed(StageTimes& times, const std::string& stage, Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    const auto stop = [&] {
        times.add(stage,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    };
    if constexpr (std::is_void_v<decltype(work())>) {
        work();
        stop();
    } else {
        auto result = work();
        stop();
        return result;
    }
}

}  // namespace livery
