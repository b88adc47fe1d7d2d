#include "live/bench_thread.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "core/error.h"
#include "core/freed_memory.h"
#include "live/bench_picture.h"
#include "live/calibration_reuse.h"
#include "live/low_priority.h"
#include "live/orbit.h"
#include "live/projector_setup.h"
#include "twin/bench.h"
#include "twin/pixel_rays.h"

namespace livery {

namespace {

constexpr int kMargin_px = 12;

struct PhotographRequest {
    std::uint64_t number = 0;
    std::shared_ptr<const Image8> drive;
    glm::dvec3 eye_mm{0.0};
    double design_white_y = 0.0;
};

struct BenchChoice {
    std::string bench;
    std::shared_ptr<const Product> product;
    bool operator==(const BenchChoice&) const = default;
};

/// What a bench is traced for.
struct Traced {
    BenchChoice choice;
    std::optional<glm::dvec3> eye_mm;  ///< its camera there; none: where the bench has it
    bool operator==(const Traced&) const = default;
};

}  // namespace

struct BenchThread::Implementation {
    std::function<void()> on_change;

    mutable std::mutex mutex;
    std::condition_variable wake;
    bool stop = false;
    BenchChoice choice;
    std::optional<PhotographRequest> requested;
    bool calibration_wanted = false;
    Calibrating calibrating;
    std::shared_ptr<const BenchPhotograph> newest;
    std::atomic<bool> abandon{false};  ///< what runs now
    std::thread thread;

    // Of the thread only
    Traced traced;
    std::unique_ptr<Bench> bench;
    PixelRectangle mockup;

    void run();
    void photograph(const PhotographRequest& request, const BenchChoice& with);
    Image8 picture_of(const PhotographRequest& request, const BenchChoice& with);
    void calibrate(const BenchChoice& with);
    void trace(const Traced& with, const Progress& progress);
    Progress abandonable();
    template <typename Change>
    void publish(const Change& change);
};

template <typename Change>
void BenchThread::Implementation::publish(const Change& change) {
    {
        const std::scoped_lock lock(mutex);
        change();
    }
    on_change();
}

Progress BenchThread::Implementation::abandonable() {
    Progress progress;
    progress.stop = &abandon;
    return progress;
}

void BenchThread::Implementation::trace(const Traced& with, const Progress& progress) {
    if (bench && traced == with) return;
    bench.reset();
    BenchDescription description = read_bench_file(with.choice.bench);
    const Mesh& mesh = with.choice.product->mesh;
    View& view = description.camera.view;
    if (with.eye_mm) view = eye_view(*with.eye_mm, bounds_of(mesh), view.width, view.height);
    bench = std::make_unique<Bench>(description, with.choice.product, progress);
    mockup = pixels_that_see(view, mesh, kMargin_px);
    traced = with;
}

Image8 BenchThread::Implementation::picture_of(const PhotographRequest& request,
                                               const BenchChoice& with) {
    trace({with, request.eye_mm}, abandonable());
    const BenchPorts ports = bench->ports();
    ports.show(*request.drive);
    Photograph taken = ports.photograph(bench->default_exposure_s());
    // A slow projector still shows the picture before
    for (int late = 0; late < bench->description().projector.latency_photographs; ++late) {
        taken = ports.photograph(0.0);
    }
    return srgb_from_photograph(taken, bench->description(), mockup, request.design_white_y);
}

void BenchThread::Implementation::photograph(const PhotographRequest& request,
                                             const BenchChoice& with) {
    const auto start = std::chrono::steady_clock::now();
    auto result = std::make_shared<BenchPhotograph>();
    try {
        result->srgb = picture_of(request, with);
    } catch (const Cancelled&) {
        const std::scoped_lock lock(mutex);
        if (!requested) requested = request;  // on the bench that is used now
        return;
    } catch (const std::exception& error) {
        result->problem = error.what();
        if (const auto last = newest) result->srgb = last->srgb;
    }
    result->number = request.number;
    result->seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    publish([&] { newest = result; });
}

void BenchThread::Implementation::calibrate(const BenchChoice& with) {
    Progress progress = abandonable();
    progress.report = [&](double fraction, std::string_view stage) {
        publish([&] {
            calibrating.fraction = fraction;
            calibrating.stage = stage;
        });
    };
    Calibrating result;
    try {
        trace({with, std::nullopt}, progress);
        const std::string key = bench_key(with.bench, *with.product);
        const auto folder = calibrate_on_bench(*bench, *with.product, progress);
        note_bench(folder, key);
        result.finished = folder;
    } catch (const Cancelled&) {
    } catch (const Refused& refused) {
        result.refused_why = refused.why();
        result.refused_fix = refused.fix();
    } catch (const std::exception& error) {
        result.refused_why = error.what();
        result.refused_fix = "Put that right and calibrate again.";
    }
    publish([&] { calibrating = result; });
}

void BenchThread::Implementation::run() {
    lower_priority_of_this_thread(Urgency::background);
    std::unique_lock lock(mutex);
    while (true) {
        wake.wait(lock, [&] { return stop || calibration_wanted || requested; });
        if (stop) return;
        abandon = false;
        const BenchChoice with = choice;
        if (calibration_wanted) {
            calibration_wanted = false;
            lock.unlock();
            calibrate(with);
        } else {
            const PhotographRequest request = std::move(*requested);
            requested.reset();
            lock.unlock();
            photograph(request, with);
        }
        return_freed_memory();
        lock.lock();
    }
}

BenchThread::BenchThread(std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->on_change = std::move(on_change);
    implementation_->thread = std::thread([this] { implementation_->run(); });
}

BenchThread::~BenchThread() {
    {
        const std::scoped_lock lock(implementation_->mutex);
        implementation_->stop = true;
        implementation_->abandon = true;
    }
    implementation_->wake.notify_all();
    implementation_->thread.join();
}

void BenchThread::use(const std::string& bench, std::shared_ptr<const Product> product) {
    check_argument(product != nullptr, "a bench without a mock-up");
    const std::scoped_lock lock(implementation_->mutex);
    BenchChoice choice{bench, std::move(product)};
    if (choice == implementation_->choice) return;
    implementation_->choice = std::move(choice);
    implementation_->abandon = true;
}

void BenchThread::photograph(std::uint64_t number,
                             std::shared_ptr<const Image8> drive,
                             const glm::dvec3& eye_mm,
                             double design_white_y) {
    check_argument(drive != nullptr, "a photograph of no picture");
    {
        const std::scoped_lock lock(implementation_->mutex);
        check_argument(implementation_->choice.product != nullptr, "a photograph on no bench");
        implementation_->requested =
            PhotographRequest{number, std::move(drive), eye_mm, design_white_y};
    }
    implementation_->wake.notify_all();
}

std::shared_ptr<const BenchPhotograph> BenchThread::newest_photograph() const {
    const std::scoped_lock lock(implementation_->mutex);
    return implementation_->newest;
}

void BenchThread::start_calibration() {
    {
        const std::scoped_lock lock(implementation_->mutex);
        check_argument(implementation_->choice.product != nullptr, "a calibration on no bench");
        if (implementation_->calibrating.running) return;
        implementation_->calibrating = {};
        implementation_->calibrating.running = true;
        implementation_->calibrating.stage = "waiting for the bench";
        implementation_->calibration_wanted = true;
    }
    implementation_->wake.notify_all();
}

void BenchThread::cancel_calibration() {
    const std::scoped_lock lock(implementation_->mutex);
    Implementation& it = *implementation_;
    if (!it.calibrating.running) return;
    if (it.calibration_wanted) {
        it.calibration_wanted = false;
        it.calibrating = {};
    } else {
        it.abandon = true;
    }
}

BenchThread::Calibrating BenchThread::calibrating() const {
    const std::scoped_lock lock(implementation_->mutex);
    return implementation_->calibrating;
}

}  // namespace livery
