#include "studio/window/first_calibration.h"

#include <algorithm>
#include <exception>
#include <string>

#include "live/projector_setup.h"
#include "studio/calibration_panel.h"
#include "studio/kit/words.h"
#include "studio/window/shell.h"

namespace livery {

namespace {

constexpr const char* kCalibrating = "Calibrating the simulated bench.";
constexpr const char* kCalibratedKey = "calibrated-once";

bool needs_first_calibration(const Session& session) {
    return session.document().calibration.empty() && !session.workspace().contains(kCalibratedKey);
}

}  // namespace

void find_first_calibration(Shell& shell) {
    Studio& studio = shell.studio;
    if (!needs_first_calibration(studio.session)) return;
    studio.background->run(
        [&shell, bench = studio.session.document().bench, product = studio.product](
            const Progress&) -> Background::Then {
            const auto kept = kept_calibration_of(bench_key(bench, *product));
            return [&shell, kept] {
                Studio& there = shell.studio;
                shell.calibrates_after_first_frame = !kept;
                if (!kept || !needs_first_calibration(there.session)) return;
                there.session.set_workspace(kCalibratedKey, "yes");
                commit(there, SetCalibration{kept->string()});
            };
        },
        [&shell](std::exception_ptr why) {
            shell.calibrates_after_first_frame = true;
            notify_failure(
                shell.studio, "Calibrations made before could not be looked through.", why);
        });
}

void start_first_calibration(Shell& shell) {
    Studio& studio = shell.studio;
    // Behind the page of a new session it would be for nothing.
    if (!shell.calibrates_after_first_frame || !studio.frame || shell.new_session) return;
    shell.calibrates_after_first_frame = false;
    if (!needs_first_calibration(studio.session)) return;
    studio.bench->start_calibration();
    shell.calibrates_by_itself = true;
    notify(studio,
           {Notice::Level::info,
            kCalibrating,
            "There is no calibration yet. This happens beside your work: a minute or two where "
            "nothing else is done, longer while you work.",
            "Until it is done, pictures go to the projector uncorrected.",
            studio.now_s + 3600.0});
}

void take_calibration(Shell& shell) {
    Studio& studio = shell.studio;
    const auto calibrating = studio.bench->calibrating();
    const auto take_back_notice = [&] {
        std::erase_if(studio.notices, [](const Notice& n) { return n.what == kCalibrating; });
    };
    const bool by_itself = shell.calibrates_by_itself;
    shell.calibrates_by_itself = by_itself && calibrating.running;
    if (by_itself && !studio.session.document().calibration.empty()) {
        // Somebody has loaded one meanwhile: theirs stays.
        studio.session.set_workspace(kCalibratedKey, "yes");
        take_back_notice();
        if (calibrating.running) studio.bench->cancel_calibration();
        if (calibrating.finished) studio.panels.calibration->taken = *calibrating.finished;
        return;
    }
    // The panel tells the person who asked; nobody asked for this one.
    if (!calibrating.refused_why.empty() && by_itself) {
        take_back_notice();
        notify(studio,
               {Notice::Level::error,
                "The simulated bench could not be calibrated; pictures stay uncorrected.",
                sentence(calibrating.refused_why),
                sentence(calibrating.refused_fix)});
    }
    if (!calibrating.finished || *calibrating.finished == studio.panels.calibration->taken) return;
    studio.panels.calibration->taken = *calibrating.finished;
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

}  // namespace livery
