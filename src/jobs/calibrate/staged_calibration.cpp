#include "jobs/calibrate/staged_calibration.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "calibration/correspondence/patterns.h"
#include "calibration/drift.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/captured_calibration.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

/// Before a stage begins: latency and exposure, and white and black at its end.
constexpr int kToMeet = 20;

/// The stage's recording, opened for as long as it runs.
Recording recording_of(const StagedCalibration& run, CalibrationStage stage) {
    return Recording(folder_of(run, stage), run.settings.made_with);
}

void remove_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::remove_all(folder, error);
    if (error) throw FileError(folder, "", error.message(), "a folder that can be emptied");
}

/// Whether two masks differ by no more than a pixel at their edges.
bool are_nearly_alike(const Image8& a, const Image8& b) {
    if (a.width != b.width || a.height != b.height) return false;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            if (a.at(x, y) == b.at(x, y)) continue;
            bool at_edge = false;
            for (int v = std::max(0, y - 1); v <= std::min(a.height - 1, y + 1); ++v)
                for (int u = std::max(0, x - 1); u <= std::min(a.width - 1, x + 1); ++u)
                    at_edge = at_edge || a.at(u, v) == b.at(x, y);
            if (!at_edge) return false;
        }
    return true;
}

/// What is lit for the colours. A pose that was found again, hardly another, lights what the
/// photographs that are there were lit with: these stay right.
Image8 lit_for(const CalibrationSettings& settings, const std::filesystem::path& colours) {
    Image8 lit = mockup_of(settings);
    const auto file = colours / "lit.png";
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
        const ImageF kept = read_image(file).image;
        Image8 before(kept.width, kept.height, 1);
        for (std::size_t i = 0; i < before.values.size(); ++i)
            before.values[i] =
                kept.values[i * static_cast<std::size_t>(kept.channels)] > 0.0f ? 255 : 0;
        if (are_nearly_alike(before, lit)) return before;
    }
    write_png(file, lit);
    return lit;
}

/// A place that was found for a mock-up that stands elsewhere now would spoil the colours.
void check_that_nothing_moved(const RoomPose& room, const CalibrationResult& made) {
    if (room.seen.white.image.empty() || made.white.image.empty()) return;
    constexpr double kMoved_px = 1.0;  // what a look for drift calls Bad
    try {
        const Drift drift =
            drift_where_both_lit(drift_reference(room.seen.white, room.seen.black, 0),
                                 drift_reference(made.white, made.black, 0));
        if (drift.lost <= drift.blocks && drift.shift_median_px < kMoved_px) return;
        throw Refused(
            drift.lost > drift.blocks
                ? std::string("the mock-up is not where the geometry found it")
                : fmt::format("the mock-up, the camera or the projector moved by about {:.1f} "
                              "camera pixels after the geometry was photographed",
                              drift.shift_median_px),
            "let everything stand still, and photograph the geometry again");
    } catch (const FileError&) {
        throw Refused("the camera's pictures have another size than those of the geometry",
                      "set the camera as it was, or photograph the geometry again");
    }
}

}  // namespace

std::filesystem::path folder_of(const StagedCalibration& run, CalibrationStage stage) {
    if (!finds_room(run.settings)) return run.folder;
    return run.folder / (stage == CalibrationStage::geometry ? "geometry" : "colour");
}

bool can_go_on(const StagedCalibration& run, CalibrationStage stage) {
    if (stage == CalibrationStage::check) return false;
    if (stage == CalibrationStage::geometry && !finds_room(run.settings)) return false;
    std::error_code error;
    const auto folder = folder_of(run, stage);
    return std::filesystem::exists(folder / "recording.json", error) &&
           !std::filesystem::exists(folder / "manifest.json", error);
}

void forget(StagedCalibration& run, CalibrationStage stage) {
    run.check.reset();
    if (stage == CalibrationStage::check) return;
    run.made.reset();
    remove_folder(folder_of(run, CalibrationStage::colour));
    if (stage == CalibrationStage::colour) return;
    run.room.reset();
    remove_folder(folder_of(run, CalibrationStage::geometry));
}

void find_geometry(StagedCalibration& run,
                   const BenchPorts& ports,
                   const MeetRecording& meet,
                   const Progress& progress) {
    Recording recording = recording_of(run, CalibrationStage::geometry);
    if (meet) meet(recording);
    run.made.reset();
    run.check.reset();
    run.room = find_room_for(ports, run.settings, progress, &recording);
}

void find_colours(StagedCalibration& run,
                  const BenchPorts& ports,
                  const MeetRecording& meet,
                  const Progress& progress) {
    const bool finds = finds_room(run.settings);
    const bool first = finds && !run.room;
    if (first) find_geometry(run, ports, meet, progress.part(0.0, 0.4));
    Recording recording = recording_of(run, CalibrationStage::colour);
    if (meet) meet(recording);
    CalibrationSettings settings = finds ? with_room(run.settings, *run.room) : run.settings;
    if (finds) settings.mockup = lit_for(settings, recording.folder());
    run.check.reset();
    run.made.reset();
    CalibrationResult made;
    try {
        made = calibrate_through_ports(
            ports, std::move(settings), first ? progress.part(0.4, 1.0) : progress, &recording);
    } catch (const Refused& refused) {
        if (!finds) throw;
        // With a map of where things were, whatever is photographed shows something else.
        throw Refused(
            refused.why(),
            refused.fix() + "; if anything has moved since, photograph the geometry again");
    }
    if (finds) {
        check_that_nothing_moved(*run.room, made);
        made.room = run.room;
        // Of the mock-up alone, as it was lit.
        write_map(recording.folder() / "map.exr", made.map);
    }
    run.made = std::move(made);
}

bool can_check(const StagedCalibration& run) {
    return run.made && run.made->projector && run.settings.product &&
           !run.made->white.image.empty();
}

void check_colours(StagedCalibration& run, const BenchPorts& ports, const Progress& progress) {
    check_argument(can_check(run), "a check needs colours, a camera and the mock-up's pose");
    const CalibrationResult& made = *run.made;
    run.check = check_calibration(ports,
                                  made.calibration,
                                  made.map,
                                  mockup_mask(run.settings.product->mesh, *made.projector),
                                  made.white,
                                  made.latency_photographs,
                                  progress);
}

int expected_photographs(const CalibrationSettings& settings, CalibrationStage stage) {
    const int geometry =
        static_cast<int>(place_roles(settings.places, settings.width, settings.height).size());
    const int colours = 6 * settings.shots;
    switch (stage) {
        case CalibrationStage::geometry:
            return finds_room(settings) ? kToMeet + geometry : 0;
        case CalibrationStage::colour:
            return kToMeet + colours + (finds_room(settings) ? 2 : geometry);
        case CalibrationStage::check:
            return 4;
    }
    throw std::invalid_argument("unknown stage");
}

std::vector<GradedFigure> grade_figures(const RoomGeometry& room) {
    std::vector<GradedFigure> figures;
    figures.push_back(
        {"Mock-up in its place",
         fmt::format("{:.2f} px", room.median_px),
         "projector pixels, median; good under 0.5, usable under 1",
         "How far the mock-up's pixels are seen from where mesh and pose have them.",
         "Check that the mesh is that of the mock-up, and that nothing moved while it was "
         "photographed.",
         grade_of(room.median_px, 0.5, 1.0)});
    figures.push_back(graded_share("Mesh that is seen",
                                   room.agreement,
                                   0.85,
                                   0.6,
                                   "Of the mesh that projector and camera both face, what is "
                                   "there in the photographs.",
                                   "Light all of the mock-up, and take away what stands before "
                                   "it."));
    figures.push_back(
        {"Lenses' rays meet within",
         fmt::format("{:.2f} px", room.pair_median_px),
         "camera pixels, median; good under 0.5, usable under 1.5",
         "How well projector and camera agree by themselves, without the mesh.",
         "Check the data sheets' figures: throw ratio, lens shift, focal length, sensor width.",
         grade_of(room.pair_median_px, 0.5, 1.5)});
    return figures;
}

}  // namespace livery
