#include "live/capture_thread.h"

#include <exception>
#include <thread>
#include <utility>

#include "capture/camera.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/memory.h"
#include "core/paths.h"
#include "core/time.h"
#include "jobs/capture_bench.h"
#include "live/capture_work.h"
#include "live/low_priority.h"

namespace livery {

Progress CaptureThread::Implementation::progress() {
    Progress progress;
    progress.stop = &abandon;
    progress.report = [this](double fraction, std::string_view stage) {
        const double elapsed_s =
            std::chrono::duration<double>(CaptureClock::now() - started).count();
        publish([&](CaptureView& view) {
            view.fraction = fraction;
            view.stage = stage;
            view.elapsed_s = elapsed_s;
            view.remaining_s.reset();
            if (fraction > 0.05) view.remaining_s = elapsed_s * (1.0 - fraction) / fraction;
        });
    };
    return progress;
}

template <typename Work>
void CaptureThread::Implementation::attempt(CaptureView::Doing doing, const Work& work) {
    started = CaptureClock::now();
    publish([&](CaptureView& view) {
        view.doing = doing;
        view.fraction = 0.0;
        view.stage.clear();
        view.elapsed_s = 0.0;
        view.remaining_s.reset();
        view.why.clear();
        view.fix.clear();
    });
    std::string why, fix;
    try {
        work();
    } catch (const Cancelled&) {
    } catch (const Refused& refused) {
        why = refused.why();
        fix = refused.fix();
    } catch (const std::exception& error) {
        why = error.what();
        fix = "Put that right and try again.";
    }
    // Light to aim and to focus by; a real projector goes back to its frames.
    if (bench.show) {
        const View& projector = bench.simulated->description().projector.view;
        bench.show(Image8(projector.width, projector.height, 3, 255));
    }
    show_steps();
    publish([&](CaptureView& view) {
        view.doing = bench.camera ? CaptureView::Doing::watching : CaptureView::Doing::nothing;
        view.why = why;
        view.fix = fix;
        view.wait = {};
        view.waits_for_next = false;
        view.shown.reset();
    });
}

void CaptureThread::Implementation::open(const CaptureSetup& with) {
    const bool stays = bench.camera && with.camera == setup.camera &&
                       (!bench.simulated || with.product == setup.product);
    setup = with;
    if (!stays) {
        bench = {};
        run = {};
        publish([&](CaptureView& view) {
            view = {};
            view.paused = paused;
        });
    }
    attempt(CaptureView::Doing::opening, [&] {
        if (is_by_hand() || stays) return;
        bench = open_capture_bench(setup.camera, setup.product, progress());
        show_state();
        publish([&](CaptureView& view) {
            view.camera = bench.name;
            view.may_have_curve = !traits_of(setup.camera).is_simulated;
            if (bench.curve) view.curve = "the curve kept in " + bench.curve->string();
        });
    });
}

void CaptureThread::Implementation::show_state() {
    const CameraState state = bench.camera->state();
    publish([&](CaptureView& view) {
        view.settings = state.settings;
        view.warnings = state.warnings;
    });
}

void CaptureThread::Implementation::set(
    const std::vector<std::pair<std::string, std::string>>& settings) {
    publish([](CaptureView& view) { view.why.clear(); });
    try {
        for (const auto& [setting, value] : settings) bench.camera->set(setting, value);
        show_state();
    } catch (const CameraFault& fault) {
        publish([&](CaptureView& view) {
            view.why = fault.why();
            view.fix = fault.fix();
        });
    }
}

void CaptureThread::Implementation::watch() {
    try {
        const Image8 seen = bench.camera->live_view();
        if (seen.empty()) {
            worker.use([](CaptureJobs& asked) { asked.watching = false; });
            publish([](CaptureView& view) { view.has_live_view = false; });
            return;
        }
        const CaptureHistogram histogram = histogram_of(seen);
        const auto picture = std::make_shared<Image8>(small_picture(seen, kLiveWidth_px));
        publish([&](CaptureView& view) {
            view.live = picture;
            view.histogram = histogram;
            view.wait = {};
        });
    } catch (const CameraFault& fault) {
        publish([&](CaptureView& view) { view.wait = {fault.why(), fault.fix()}; });
    }
    for (auto left = kBetweenLiveViews; left.count() > 0 && !abandon; left -= kBetweenLooks)
        std::this_thread::sleep_for(kBetweenLooks);
}

void CaptureThread::Implementation::wait_while_paused() const {
    while (paused) {
        if (abandon) throw Cancelled();
        std::this_thread::sleep_for(kBetweenLooks);
    }
}

/// The bench's ports, with what passes through them shown to people.
BenchPorts CaptureThread::Implementation::ports() {
    const TellWait tell = [this](const CaptureWait& wait) {
        publish([&](CaptureView& view) { view.wait = wait; });
    };
    const Progress stoppable{{}, &abandon};
    const ShowPicture show = bench.show ? bench.show : setup.projector_port(stoppable, tell);
    BenchPorts ports;
    ports.show = [this, show](const Image8& drive) {
        wait_while_paused();
        timed(times.seconds, [&] { show(drive); });
        const auto small = std::make_shared<Image8>(small_picture(drive, kTileWidth_px));
        publish([&](CaptureView& view) { view.shown = small; });
    };
    if (bench.camera)
        ports.photograph = [this, take = patient(*bench.camera, stoppable, tell)](double asked_s) {
            ++times.photographs;
            return timed(times.seconds, [&] { return take(asked_s); });
        };
    ports.measure_xyz = bench.measure_xyz;
    return ports;
}

Worker<CaptureJobs>::Turn CaptureThread::Implementation::next(CaptureJobs& asked) {
    abandon = false;
    if (std::exchange(asked.open, false))
        return {[this, with = asked.setup] {
            open(with);
            worker.use([this](CaptureJobs& jobs) { jobs.watching = bench.camera != nullptr; });
        }};
    if (std::exchange(asked.shut, false))
        return {[this] {
            bench = {};
            run = {};
            publish([](CaptureView& view) { view = {}; });
        }};
    if (!asked.settings.empty() && bench.camera)
        return {[this, settings = std::exchange(asked.settings, {})] { set(settings); }};
    if (std::exchange(asked.fit, false))
        return {[this] { attempt(CaptureView::Doing::fitting, [this] { fit_curve(); }); }};
    if (asked.drift)
        return {[this, calibration = *std::exchange(asked.drift, std::nullopt)] {
            attempt(CaptureView::Doing::checking, [&] { look_for_drift_now(calibration); });
        }};
    if (asked.repose)
        return {[this, calibration = *std::exchange(asked.repose, std::nullopt)] {
            attempt(CaptureView::Doing::checking, [&] { find_mockup_now(calibration); });
        }};
    if (asked.step) {
        const CaptureStep step = *std::exchange(asked.step, std::nullopt);
        const bool anew = std::exchange(asked.anew, false);
        return {[this, step, anew, again = std::exchange(asked.again, {})] {
            attempt(doing_of(step), [&] { take_step(step, anew, again); });
            return_freed_memory();
        }};
    }
    if (asked.watching && bench.camera) return {[this] { watch(); }};
    return {};
}

CaptureThread::CaptureThread(GlContext& context, std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>(context, std::move(on_change))) {
    Implementation& it = *implementation_;
    it.worker.start([&it] {
        lower_priority_of_this_thread(Urgency::watched);
        it.context.make_current();
        it.worker.serve([&it](CaptureJobs& asked) { return it.next(asked); });
        it.bench = {};
        it.context.release();
    });
}

CaptureThread::~CaptureThread() {
    implementation_->worker.stop();  // first: the next job would take `abandon` back
    implementation_->abandon = true;
}

void CaptureThread::use(CaptureSetup setup) {
    implementation_->worker.change([&](CaptureJobs& asked) {
        implementation_->abandon = true;
        asked.setup = std::move(setup);
        asked.fit = asked.watching = asked.shut = false;
        asked.step.reset();
        asked.drift.reset();
        asked.repose.reset();
        asked.settings.clear();
        asked.open = true;
    });
}

void CaptureThread::close() {
    implementation_->worker.change([&](CaptureJobs& asked) {
        implementation_->abandon = true;
        asked.open = asked.fit = asked.watching = false;
        asked.step.reset();
        asked.drift.reset();
        asked.repose.reset();
        asked.settings.clear();
        asked.shut = true;
    });
}

void CaptureThread::set(const std::string& setting, const std::string& value) {
    implementation_->worker.change(
        [&](CaptureJobs& asked) { asked.settings.emplace_back(setting, value); });
}

void CaptureThread::start_curve_fit() {
    implementation_->worker.change([](CaptureJobs& asked) { asked.fit = true; });
}

void CaptureThread::start(CaptureStep step, bool anew) {
    implementation_->worker.change([&](CaptureJobs& asked) {
        asked.step = step;
        asked.anew = anew;
    });
}

void CaptureThread::look_for_drift(std::filesystem::path calibration) {
    implementation_->worker.change(
        [&](CaptureJobs& asked) { asked.drift = std::move(calibration); });
}

void CaptureThread::find_mockup_again(std::filesystem::path calibration) {
    implementation_->worker.change(
        [&](CaptureJobs& asked) { asked.repose = std::move(calibration); });
}

void CaptureThread::take_again(std::size_t showing) {
    implementation_->worker.change([&](CaptureJobs& asked) {
        asked.again.push_back(showing);
        if (!asked.step) asked.step = photographed_last(asked.view);
        implementation_->abandon = true;  // It begins again, and is answered from the folder.
    });
}

void CaptureThread::set_paused(bool paused) {
    implementation_->paused = paused;
    implementation_->worker.use([&](CaptureJobs& asked) { asked.view.paused = paused; });
}

void CaptureThread::next() { implementation_->next_picture = true; }

void CaptureThread::cancel() {
    implementation_->worker.use([&](CaptureJobs& asked) {
        asked.fit = false;
        asked.step.reset();
        asked.drift.reset();
        asked.repose.reset();
        implementation_->abandon = true;
    });
}

CaptureView CaptureThread::view() const {
    return implementation_->worker.use([](const CaptureJobs& asked) { return asked.view; });
}

std::filesystem::path CaptureThread::folder(const std::string& made_with) {
    Hasher hasher;
    hasher.add(made_with);
    return user_folder() / "captures" / hasher.hex().substr(0, 16);
}

}  // namespace livery
