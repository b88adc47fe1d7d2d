// The simulated bench is calibrated by itself for whoever has no calibration yet.

#include <algorithm>

#include "live/projector_setup.h"
#include "studio/calibrate/calibration_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

constexpr const char* kCalibrating = "Calibrating the simulated bench.";
constexpr const char* kCalibratedKey = "calibrated-once";

CalibrationPanelState& calibration_of(Studio& studio) {
    return studio.panels.of<CalibrationPanelState>();
}

bool needs_first_calibration(const Session& session) {
    return session.document().calibration.empty() && !session.workspace().contains(kCalibratedKey);
}

/// A new session of a product that was calibrated on this bench before takes that calibration; if
/// there is none, it is made after the first picture.
void find_first_calibration(Studio& studio) {
    if (!needs_first_calibration(studio.session)) return;
    studio.background->run(
        [&studio, bench = studio.session.document().bench, product = studio.product](
            const Progress&) -> Background::Then {
            const auto kept = kept_calibration_of(bench_key(bench, *product));
            return [&studio, kept] {
                calibration_of(studio).starts_after_first_frame = !kept;
                if (!kept || !needs_first_calibration(studio.session)) return;
                studio.session.set_workspace(kCalibratedKey, "yes");
                commit(studio, SetCalibration{kept->string()});
            };
        },
        [&studio](std::exception_ptr why) {
            calibration_of(studio).starts_after_first_frame = true;
            notify_failure(studio, "Calibrations made before could not be looked through.", why);
        });
}

/// As soon as there is a first picture, while everything works uncorrected.
void start_first_calibration(Studio& studio) {
    // Behind the page of a new session it would be for nothing.
    if (!calibration_of(studio).starts_after_first_frame || !studio.frame ||
        is_open(studio, "new-session"))
        return;
    calibration_of(studio).starts_after_first_frame = false;
    if (!needs_first_calibration(studio.session)) return;
    studio.bench->start_calibration();
    calibration_of(studio).started_by_itself = true;
    tell_info(studio,
              kCalibrating,
              "There is no calibration yet. This happens beside your work: a minute or two where "
              "nothing else is done, longer while you work.",
              "Until it is done, pictures go to the projector uncorrected.",
              studio.now_s + 3600.0);
}

/// Loads what a calibration that has ended made, whoever asked for it, and tells why there is none.
void take_calibration(Studio& studio) {
    const auto calibrating = studio.bench->calibrating();
    const auto take_back_notice = [&] {
        std::erase_if(studio.notices, [](const Notice& n) { return n.what == kCalibrating; });
    };
    const bool by_itself = calibration_of(studio).started_by_itself;
    calibration_of(studio).started_by_itself = by_itself && calibrating.running;
    if (by_itself && !studio.session.document().calibration.empty()) {
        // Somebody has loaded one meanwhile: theirs stays.
        studio.session.set_workspace(kCalibratedKey, "yes");
        take_back_notice();
        if (calibrating.running) studio.bench->cancel_calibration();
        if (calibrating.finished) calibration_of(studio).taken = *calibrating.finished;
        return;
    }
    // The panel tells the person who asked; nobody asked for this one.
    if (!calibrating.refused_why.empty() && by_itself) {
        take_back_notice();
        tell_error(studio,
                   "The simulated bench could not be calibrated; pictures stay uncorrected.",
                   sentence(calibrating.refused_why),
                   sentence(calibrating.refused_fix));
    }
    if (!calibrating.finished || *calibrating.finished == calibration_of(studio).taken) return;
    calibration_of(studio).taken = *calibrating.finished;
    studio.session.set_workspace(kCalibratedKey, "yes");
    stop_trying(studio);
    take_back_notice();
    commit(studio, SetCalibration{calibrating.finished->string()});
    Notice notice{Notice::Level::info, "The bench is calibrated.", "", ""};
    if (studio.view != StageView::photograph) {
        notice.fix = "Choose Photograph above the picture to see what an audience would see.";
        notice.shown_until_s = studio.now_s + 30.0;
    }
    notify(studio, notice);
}

void step_calibration(Studio& studio) {
    start_first_calibration(studio);
    take_calibration(studio);
}

void describe_calibration(const Studio& studio, MapState& state) {
    state["calibration"] = map_text(studio.session.document().calibration);
    state["calibrating"] = map_text(studio.bench->calibrating().running);
}

}  // namespace

Panel calibration_panel() {
    return {.name = "Calibrate",
            .place = PanelPlace::tab,
            .draw = draw_calibration_panel,
            .start = find_first_calibration,
            .step = step_calibration,
            .next_change_s =
                [](const Studio& s) {
                    return s.bench->calibrating().running ? s.now_s + kProgress_s : 0.0;
                },
            .holds_picture = [](const Studio& s) { return s.bench->calibrating().running; },
            .describe = describe_calibration};
}

}  // namespace livery
