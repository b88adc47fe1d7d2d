// What the capture's steps need besides a camera.
#pragma once

#include <array>
#include <filesystem>
#include <utility>
#include <vector>

#include "calibration/drift.h"
#include "jobs/calibrate/staged_calibration.h"
#include "live/capture_thread.h"

namespace livery {

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
bool asks_for_the_same(const BenchCalibrationRequest& a, const BenchCalibrationRequest& b);

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

}  // namespace livery
