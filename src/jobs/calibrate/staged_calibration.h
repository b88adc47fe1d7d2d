// A calibration in stages: where everything stands, the colours, the check. Each keeps its
// photographs, so that it can be stopped, gone on with, and done anew alone.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "capture/recording.h"
#include "core/bench_ports.h"
#include "core/grade.h"
#include "core/progress.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_check.h"

namespace livery {

enum class CalibrationStage { geometry, colour, check };

struct StagedCalibration {
    /// Of the photographs: those of the geometry and of the colours lie in `geometry` and `colour`
    /// below it, or, where no geometry is to be found, all in it.
    std::filesystem::path folder;
    CalibrationSettings settings;
    std::optional<RoomPose> room;
    std::optional<CalibrationResult> made;
    std::optional<CalibrationCheck> check;
};

/// Called with a stage's recording before it runs: to take pictures again, to be told of them.
using MeetRecording = std::function<void(Recording&)>;

/// Where a stage keeps its photographs; a check keeps none.
std::filesystem::path folder_of(const StagedCalibration& run, CalibrationStage stage);
/// Whether photographs of a stage that was stopped lie there.
bool can_go_on(const StagedCalibration& run, CalibrationStage stage);
/// Forgets what a stage photographed and found, and all that follows from it.
void forget(StagedCalibration& run, CalibrationStage stage);

/// Where everything stands; nothing is photographed that is there. The settings must be such
/// that finds_room(). Throws as find_room_for().
void find_geometry(StagedCalibration& run,
                   const BenchPorts& ports,
                   const MeetRecording& meet,
                   const Progress& progress);
/// The colours, and before them the geometry, where it is to be found and was not. Throws as
/// calibrate_through_ports().
void find_colours(StagedCalibration& run,
                  const BenchPorts& ports,
                  const MeetRecording& meet,
                  const Progress& progress);
/// Corrected colours, photographed. Throws as check_calibration(), std::invalid_argument before the
/// colours, and where the photographs were taken before or the mock-up's pose is not known.
void check_colours(StagedCalibration& run, const BenchPorts& ports, const Progress& progress);
bool can_check(const StagedCalibration& run);

/// Photographs that a stage takes, when all goes well.
int expected_photographs(const CalibrationSettings& settings, CalibrationStage stage);

/// What the geometry is worth.
std::vector<GradedFigure> grade_figures(const RoomGeometry& room);

}  // namespace livery
