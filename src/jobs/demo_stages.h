// The stages that both demos share: the bench with its calibration, and one design judged on it.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "calibration/colour/colour.h"
#include "compensation/compensation.h"
#include "jobs/calibrate/room_pose.h"
#include "jobs/demo.h"
#include "jobs/picture.h"
#include "twin/bench.h"

namespace livery {

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
