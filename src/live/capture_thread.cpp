#include "live/capture_thread.h"

#include <atomic>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "calibration/preflight.h"
#include "capture/patient_camera.h"
#include "core/error.h"
#include "core/freed_memory.h"
#include "core/paths.h"
#include "core/worker.h"
#include "jobs/bench_calibration.h"
#include "jobs/camera_curve.h"
#include "jobs/watched_captures.h"
#include "live/capture_pictures.h"
#include "live/low_priority.h"
#include "live/projector_setup.h"

namespace livery {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLiveWidth_px = 960, kTileWidth_px = 200;
constexpr auto kBetweenLiveViews = std::chrono::milliseconds(60);
constexpr auto kBetweenLooks = std::chrono::milliseconds(20);

struct CaptureJobs {
    CaptureSetup setup;
    bool open = false, shut = false, preflight = false, fit = false, capture = false, anew = false;
    std::vector<std::pair<std::string, std::string>> settings;  ///< of the camera, to be made
    bool watching = false;           ///< the camera is open, and nothing else is to be done
    std::vector<std::size_t> again;  ///< showings
    CaptureView view;
};

}  // namespace

struct CaptureThread::Implementation {
    GlContext& context;
    std::function<void()> on_change;
    std::atomic<bool> abandon{false}, paused{false}, next_picture{false};

    // Of the thread only
    CaptureSetup setup;
    CaptureBench bench;
    Clock::time_point started;

    Worker<CaptureJobs> worker;

    Worker<CaptureJobs>::Turn next(CaptureJobs& asked);
    void open(const CaptureSetup& with);
    void show_state();
    void set(const std::vector<std::pair<std::string, std::string>>& settings);
    void watch();
    void preflight_now();
    void fit_curve();
    void capture(bool anew, const std::vector<std::size_t>& again);
    void capture_with_camera(bool anew, const std::vector<std::size_t>& again);
    void capture_by_hand();
    void show_by_hand(const std::vector<Pattern>& patterns);
    BenchPorts ports();
    BenchCalibrationRequest request() const;
    void finish(const BenchCalibration& made);
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
    bool is_by_hand() const { return setup.camera.kind == CameraChoice::Kind::folder; }
};

Progress CaptureThread::Implementation::progress() {
    Progress progress;
    progress.stop = &abandon;
    progress.report = [this](double fraction, std::string_view stage) {
        const double elapsed_s = std::chrono::duration<double>(Clock::now() - started).count();
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
    started = Clock::now();
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
    if (bench.show) bench.show(Image8(bench.projector->width, bench.projector->height, 3, 255));
    publish([&](CaptureView& view) {
        view.doing = bench.camera ? CaptureView::Doing::watching : CaptureView::Doing::nothing;
        view.why = why;
        view.fix = fix;
        view.wait = {};
        view.waits_for_next = false;
        view.shown.reset();
        std::error_code error;
        view.can_go_on = std::filesystem::exists(folder() / "recording.json", error) &&
                         !std::filesystem::exists(folder() / "manifest.json", error);
    });
}

void CaptureThread::Implementation::open(const CaptureSetup& with) {
    bench = {};
    setup = with;
    publish([&](CaptureView& view) {
        view = {};
        view.paused = paused;
    });
    attempt(CaptureView::Doing::opening, [&] {
        if (is_by_hand()) return;
        bench = open_capture_bench(setup.camera, setup.product, progress());
        show_state();
        publish([&](CaptureView& view) {
            view.camera = bench.name;
            view.may_have_curve = setup.camera.kind != CameraChoice::Kind::bench;
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
        show(drive);
        const auto small = std::make_shared<Image8>(small_picture(drive, kTileWidth_px));
        publish([&](CaptureView& view) { view.shown = small; });
    };
    if (bench.camera) ports.photograph = patient(*bench.camera, stoppable, tell);
    ports.measure_xyz = bench.measure_xyz;
    return ports;
}

BenchCalibrationRequest CaptureThread::Implementation::request() const {
    BenchCalibrationRequest request;
    request.product = setup.product;
    request.projector = bench.projector ? bench.projector : setup.projector_view;
    request.width = bench.projector ? bench.projector->width : setup.width;
    request.height = bench.projector ? bench.projector->height : setup.height;
    request.made_with = (is_by_hand() ? "photographs in " + setup.camera.what : bench.name) + ", " +
                        (bench.show ? "its own projector" : setup.projector);
    return request;
}

void CaptureThread::Implementation::preflight_now() {
    publish([](CaptureView& view) { view.figures.clear(); });
    const BenchCalibrationRequest what = request();
    const LiveOptions options = live_options_of(what);
    preflight(ports(),
              {options.width, options.height, options.mockup},
              progress(),
              [this](const GradedFigure& figure) {
                  publish([&](CaptureView& view) { view.figures.push_back(figure); });
              });
}

void CaptureThread::Implementation::fit_curve() {
    const BenchCalibrationRequest what = request();
    const CameraCurve curve =
        fit_camera_curve(*bench.camera, ports(), what.width, what.height, progress());
    publish([&](CaptureView& view) {
        view.curve = fmt::format(
            "the curve just fitted: with it, photographs of one light differ by {:.2f} %. It is "
            "kept "
            "in {}",
            100.0 * curve.residual,
            curve.file.string());
    });
}

/// Every photograph as it comes, from the camera or from the folder, becomes a tile.
void CaptureThread::Implementation::look_at(Recording& recording) {
    recording.tell([this, &recording](std::size_t showing, const Photograph& photograph) {
        const auto seen = std::make_shared<Image8>(small_photograph(photograph, kTileWidth_px));
        const CaptureHistogram histogram = histogram_of(photograph);
        const std::string of = recording.announced();
        publish([&](CaptureView& view) {
            if (view.tiles.size() <= showing) view.tiles.resize(showing + 1);
            CaptureTile& tile = view.tiles[showing];
            tile.photographs = tile.of == of ? tile.photographs + 1 : 1;
            tile.of = of;
            tile.seen = seen;
            view.histogram = histogram;
            view.taken = recording.taken();
            view.kept_from_before = recording.answered();
        });
    });
}

void CaptureThread::Implementation::finish(const BenchCalibration& made) {
    const auto kept = keep_calibration(made.calibration, request().projector);
    publish([&](CaptureView& view) {
        view.finished = kept;
        view.capture_s = made.live.capture_seconds;
        view.camera_s = made.live.camera_seconds;
        view.projector_s = made.live.projector_seconds;
    });
}

void CaptureThread::Implementation::capture_with_camera(bool anew,
                                                        const std::vector<std::size_t>& again) {
    check_calibrations_folder();
    if (anew) {
        std::error_code error;
        std::filesystem::remove_all(folder(), error);
    }
    BenchCalibrationRequest what = request();
    Recording recording(folder(), what.made_with);
    for (const std::size_t showing : again) recording.take_again(showing);
    look_at(recording);
    what.recording = &recording;
    publish([](CaptureView& view) { view.tiles.clear(); });
    finish(calibrate_through_ports(ports(), what, progress()));
}

/// One picture after the other, each until somebody says that it was taken.
void CaptureThread::Implementation::show_by_hand(const std::vector<Pattern>& patterns) {
    const ShowPicture show = ports().show;
    publish([](CaptureView& view) { view.waits_for_next = true; });
    const Progress told = progress();
    for (std::size_t k = 0; k < patterns.size(); ++k) {
        show(patterns[k].drive);
        told.update(static_cast<double>(k) / static_cast<double>(patterns.size()),
                    fmt::format("shoot {} of {}: {}", k + 1, patterns.size(), patterns[k].role));
        next_picture = false;
        while (!next_picture) {
            told.check_stop();
            std::this_thread::sleep_for(kBetweenLooks);
        }
    }
    show(Image8(setup.width, setup.height, 3));
    publish([](CaptureView& view) { view.waits_for_next = false; });
}

void CaptureThread::Implementation::capture_by_hand() {
    check_calibrations_folder();
    BenchCalibrationRequest what = request();
    const LiveOptions options = live_options_of(what);
    std::vector<Pattern> patterns = place_patterns(options.places, options.width, options.height);
    for (Pattern& pattern : colour_patterns(options.width, options.height, 0, 255))
        patterns.push_back(std::move(pattern));
    std::vector<std::string> roles;
    for (const Pattern& pattern : patterns) roles.push_back(pattern.role);
    WatchedCaptures watched(setup.camera.what, roles);
    watched.look();
    watched.look();
    if (watched.state().files == 0) show_by_hand(patterns);
    const Progress told = progress();
    told.update(0.0, fmt::format("copy the {} photographs to {}", roles.size(), setup.camera.what));
    const BenchPorts files = watched.ports(told, [&](const WatchedState& state) {
        told.update(static_cast<double>(state.found) / static_cast<double>(state.wanted),
                    text_of(state));
    });
    finish(calibrate_through_ports(files, what, told));
}

void CaptureThread::Implementation::capture(bool anew, const std::vector<std::size_t>& again) {
    publish([](CaptureView& view) { view.finished.reset(); });
    if (is_by_hand()) {
        capture_by_hand();
    } else {
        capture_with_camera(anew, again);
    }
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
            publish([](CaptureView& view) { view = {}; });
        }};
    if (!asked.settings.empty() && bench.camera)
        return {[this, settings = std::exchange(asked.settings, {})] { set(settings); }};
    if (std::exchange(asked.preflight, false))
        return {[this] { attempt(CaptureView::Doing::preflight, [this] { preflight_now(); }); }};
    if (std::exchange(asked.fit, false))
        return {[this] { attempt(CaptureView::Doing::fitting, [this] { fit_curve(); }); }};
    if (std::exchange(asked.capture, false)) {
        const bool anew = std::exchange(asked.anew, false);
        return {[this, anew, again = std::exchange(asked.again, {})] {
            attempt(CaptureView::Doing::capturing, [&] { capture(anew, again); });
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
        asked.preflight = asked.fit = asked.capture = asked.watching = asked.shut = false;
        asked.settings.clear();
        asked.open = true;
    });
}

void CaptureThread::close() {
    implementation_->worker.change([&](CaptureJobs& asked) {
        implementation_->abandon = true;
        asked.open = asked.preflight = asked.fit = asked.capture = asked.watching = false;
        asked.settings.clear();
        asked.shut = true;
    });
}

void CaptureThread::set(const std::string& setting, const std::string& value) {
    implementation_->worker.change(
        [&](CaptureJobs& asked) { asked.settings.emplace_back(setting, value); });
}

void CaptureThread::start_preflight() {
    implementation_->worker.change([](CaptureJobs& asked) { asked.preflight = true; });
}

void CaptureThread::start_curve_fit() {
    implementation_->worker.change([](CaptureJobs& asked) { asked.fit = true; });
}

void CaptureThread::start_capture(bool anew) {
    implementation_->worker.change([&](CaptureJobs& asked) {
        asked.capture = true;
        asked.anew = anew;
    });
}

void CaptureThread::take_again(std::size_t showing) {
    implementation_->worker.change([&](CaptureJobs& asked) {
        asked.again.push_back(showing);
        asked.capture = true;
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
        asked.preflight = asked.fit = asked.capture = false;
        implementation_->abandon = true;
    });
}

CaptureView CaptureThread::view() const {
    return implementation_->worker.use([](const CaptureJobs& asked) { return asked.view; });
}

std::filesystem::path CaptureThread::folder() { return user_folder() / "captures" / "last"; }

}  // namespace livery
