// What a capture's thread does: photographs made small for people with what a calibration's stages
// found marked in them, and the work that capture_thread.cpp hands over.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/correspondence/patterns.h"
#include "calibration/drift.h"
#include "core/bench_ports.h"
#include "core/image.h"
#include "core/worker.h"
#include "jobs/calibrate/staged_calibration.h"
#include "live/capture_thread.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/view.h"

namespace livery {

/// sRGB, `width` pixels wide at most, full scale a little over white.
Image8 small_photograph(const Photograph& photograph,
                        int width,
                        const glm::dvec3& balance = glm::dvec3(1.0));
/// Every so many pixels of it, so that it is `width` wide at most.
Image8 small_picture(const Image8& picture, int width);

CaptureHistogram histogram_of(const Photograph& photograph);
CaptureHistogram histogram_of(const Image8& srgb);

/// A photograph with the mesh's outline where the camera must see it; sRGB, `width` pixels wide at
/// most.
Image8 outline_on_photograph(const Photograph& photograph,
                             const View& camera,
                             const Mesh& mesh,
                             int width);

/// The projector's pixels by what they can correct: measured green, predicted blue, the mock-up's
/// others (`mockup`: one channel, non-zero) red; sRGB.
Image8 status_picture(const ColourCalibration& calibration, const Image8& mockup, int width);

/// Time in the ports, by which the next photographs are foretold.
struct CaptureTimes {
    double seconds = 0.0;
    int photographs = 0;
};

/// The steps that photograph a calibration.
inline constexpr std::array<std::pair<CaptureStep, CalibrationStage>, 3> kPhotographed{
    {{CaptureStep::geometry, CalibrationStage::geometry},
     {CaptureStep::colour, CalibrationStage::colour},
     {CaptureStep::check, CalibrationStage::check}}};

CaptureView::Doing doing_of(CaptureStep step);

/// The step whose photographs the tiles are.
CaptureStep photographed_last(const CaptureView& view);

/// Whether what was found for one holds for the other.
bool asks_for_the_same(const CalibrationSettings& a, const CalibrationSettings& b);

/// The run's calibration against one that is kept; nothing where there is none, or they cannot be
/// compared.
std::vector<GradedFigure> compared_with(const std::filesystem::path& kept,
                                        const StagedCalibration& run);

struct DriftSource {
    DriftReference then;
    Image8 mockup;
};
/// Of a kept calibration. Throws Refused where it cannot tell how the bench was.
DriftSource drift_source(const std::filesystem::path& calibration, const Product& product);

using CaptureClock = std::chrono::steady_clock;

inline constexpr int kLiveWidth_px = 960, kTileWidth_px = 200;
inline constexpr auto kBetweenLiveViews = std::chrono::milliseconds(60);
inline constexpr auto kBetweenLooks = std::chrono::milliseconds(20);

struct CaptureJobs {
    CaptureSetup setup;
    bool open = false, shut = false, fit = false, anew = false;
    std::optional<std::filesystem::path> drift;   ///< the calibration to compare with
    std::optional<std::filesystem::path> repose;  ///< the calibration to carry along
    std::optional<CaptureStep> step;
    std::vector<std::pair<std::string, std::string>> settings;  ///< of the camera, to be made
    bool watching = false;           ///< the camera is open, and nothing else is to be done
    std::vector<std::size_t> again;  ///< showings
    CaptureView view;
};

struct CaptureThread::Implementation {
    GlContext& context;
    std::function<void()> on_change;
    std::atomic<bool> abandon{false}, paused{false}, next_picture{false};

    // Of the thread only
    CaptureSetup setup;
    CaptureBench bench;
    StagedCalibration run;
    CaptureTimes times;
    Photograph white;                           ///< the newest of the geometry
    glm::dvec3 balance{1.0};                    ///< white_balance() of the newest white
    int taken_before = 0, answered_before = 0;  ///< of the step's recordings before this one
    CaptureClock::time_point started;

    Worker<CaptureJobs> worker;

    Worker<CaptureJobs>::Turn next(CaptureJobs& asked);
    void open(const CaptureSetup& with);
    void show_state();
    void set(const std::vector<std::pair<std::string, std::string>>& settings);
    void watch();
    void take_step(CaptureStep step, bool anew, const std::vector<std::size_t>& again);
    void preflight_now();
    void find_geometry_now(const std::vector<std::size_t>& again);
    void find_colours_now(const std::vector<std::size_t>& again);
    void capture_by_hand();
    void check_now();
    void look_for_drift_now(const std::filesystem::path& calibration);
    void find_mockup_now(const std::filesystem::path& calibration);
    void fit_curve();
    void show_steps();
    MeetRecording meet(const std::vector<std::size_t>& again);
    void show_by_hand(const std::vector<Pattern>& patterns);
    BenchPorts ports();
    CalibrationSettings request() const;
    void finish();
    void wait_while_paused() const;
    void look_at(Recording& recording);
    Progress progress();

    template <typename Change>
    void publish(const Change& change) {
        worker.use([&](CaptureJobs& asked) { change(asked.view); });
        on_change();
    }
    /// Runs what was asked for, and says what became of it.
    template <typename Work>
    void attempt(CaptureView::Doing doing, const Work& work);
    bool is_by_hand() const { return traits_of(setup.camera).is_by_hand; }
};

}  // namespace livery
