#include "live/bench_thread.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "core/colour.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/statistics.h"
#include "core/worker.h"
#include "live/low_priority.h"
#include "live/orbit.h"
#include "live/projector_setup.h"
#include "twin/bench.h"
#include "twin/place.h"
#include "twin/received.h"

namespace livery {

namespace {

/// 8-bit photographs are sRGB-encoded; linear ones stay as they are.
Photograph decoded(Photograph photograph, const CameraDescription& camera) {
    if (camera.encoding != CameraEncoding::srgb8) return photograph;
    constexpr double kFullScale = 16383.0;
    for (float& value : photograph.image.values) {
        const double linear = srgb_decode(static_cast<double>(value) / 255.0);
        value = static_cast<float>(linear * (kFullScale - camera.black_level_units));
    }
    return photograph;
}

double brightest(const ImageF& xyz) {
    std::vector<float> y;
    for (std::size_t i = 0; i < xyz.pixel_count(); ++i) y.push_back(xyz.values[3 * i + 1]);
    if (y.empty()) return 1.0;
    return std::max(static_cast<double>(quantile(std::move(y), 0.999)), 1e-6);
}

}  // namespace

glm::dmat3 xyz_from_bench_camera(const BenchDescription& bench) {
    SurfaceSet white;
    white.reflectances.emplace_back();
    white.reflectances.front().fill(1.0);
    const auto xyz = fold(bench, white, observer_sensor()).direct.front();
    const auto camera = fold(bench, white, camera_sensor(bench)).direct.front();
    return glm::dmat3(xyz[0], xyz[1], xyz[2]) *
           glm::inverse(glm::dmat3(camera[0], camera[1], camera[2]));
}

Image8 srgb_from_photograph(const Photograph& photograph,
                            const BenchDescription& bench,
                            const PixelRectangle& part,
                            double white_y) {
    Photograph cropped = photograph;
    cropped.image = crop(photograph.image, part);
    const ImageF xyz =
        developed(decoded(std::move(cropped), bench.camera), xyz_from_bench_camera(bench));
    return srgb_from_xyz(xyz, white_y > 0.0 ? white_y : brightest(xyz));
}

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

struct BenchJobs {
    BenchChoice choice;
    std::optional<PhotographRequest> photograph;
    bool calibration = false;
    BenchThread::Calibrating calibrating;
    std::shared_ptr<const BenchPhotograph> newest;
};

}  // namespace

struct BenchThread::Implementation {
    std::function<void()> on_change;
    std::atomic<bool> abandon{false};  ///< what runs now

    // Of the thread only
    Traced traced;
    std::unique_ptr<Bench> bench;
    PixelRectangle mockup;

    Worker<BenchJobs> worker;

    Worker<BenchJobs>::Turn next(BenchJobs& asked);
    void photograph(const PhotographRequest& request, const BenchChoice& with);
    Image8 picture_of(const PhotographRequest& request, const BenchChoice& with);
    void calibrate(const BenchChoice& with);
    void trace(const Traced& with, const Progress& progress);
    Progress abandonable();
    template <typename Change>
    void publish(const Change& change) {
        worker.use(change);
        on_change();
    }
};

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
        worker.change([&](BenchJobs& asked) {
            if (!asked.photograph) asked.photograph = request;  // on the bench that is used now
        });
        return;
    } catch (const std::exception& error) {
        result->problem = error.what();
        worker.use([&](const BenchJobs& asked) {
            if (asked.newest) result->srgb = asked.newest->srgb;
        });
    }
    result->number = request.number;
    result->seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    publish([&](BenchJobs& asked) { asked.newest = result; });
}

void BenchThread::Implementation::calibrate(const BenchChoice& with) {
    Progress progress = abandonable();
    progress.report = [&](double fraction, std::string_view stage) {
        publish([&](BenchJobs& asked) {
            asked.calibrating.fraction = fraction;
            asked.calibrating.stage = stage;
        });
    };
    Calibrating result;
    try {
        trace({with, std::nullopt}, progress);
        const std::string key = bench_key(with.bench, *with.product);
        const auto folder = calibrate_on_bench(*bench, with.product, progress);
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
    publish([&](BenchJobs& asked) { asked.calibrating = result; });
}

Worker<BenchJobs>::Turn BenchThread::Implementation::next(BenchJobs& asked) {
    if (!asked.calibration && !asked.photograph) return {};
    abandon = false;
    const BenchChoice with = asked.choice;
    if (std::exchange(asked.calibration, false)) {
        return {[this, with] {
            calibrate(with);
            return_freed_memory();
        }};
    }
    return {[this, with, request = *std::exchange(asked.photograph, std::nullopt)] {
        photograph(request, with);
        return_freed_memory();
    }};
}

BenchThread::BenchThread(std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& it = *implementation_;
    it.on_change = std::move(on_change);
    it.worker.start([&it] {
        lower_priority_of_this_thread(Urgency::background);
        it.worker.serve([&it](BenchJobs& asked) { return it.next(asked); });
    });
}

BenchThread::~BenchThread() {
    implementation_->worker.stop();  // first: the next job would take `abandon` back
    implementation_->abandon = true;
}

void BenchThread::use(const std::string& bench, std::shared_ptr<const Product> product) {
    check_argument(product != nullptr, "a bench without a mock-up");
    implementation_->worker.use([&](BenchJobs& asked) {
        BenchChoice choice{bench, std::move(product)};
        if (choice == asked.choice) return;
        asked.choice = std::move(choice);
        implementation_->abandon = true;
    });
}

void BenchThread::photograph(std::uint64_t number,
                             std::shared_ptr<const Image8> drive,
                             const glm::dvec3& eye_mm,
                             double design_white_y) {
    check_argument(drive != nullptr, "a photograph of no picture");
    implementation_->worker.change([&](BenchJobs& asked) {
        check_argument(asked.choice.product != nullptr, "a photograph on no bench");
        asked.photograph = PhotographRequest{number, std::move(drive), eye_mm, design_white_y};
    });
}

std::shared_ptr<const BenchPhotograph> BenchThread::newest_photograph() const {
    return implementation_->worker.use([](const BenchJobs& asked) { return asked.newest; });
}

void BenchThread::start_calibration() {
    implementation_->worker.change([](BenchJobs& asked) {
        check_argument(asked.choice.product != nullptr, "a calibration on no bench");
        if (asked.calibrating.running) return;
        asked.calibrating = {};
        asked.calibrating.running = true;
        asked.calibrating.stage = "waiting for the bench";
        asked.calibration = true;
    });
}

void BenchThread::cancel_calibration() {
    implementation_->worker.use([&](BenchJobs& asked) {
        if (!asked.calibrating.running) return;
        if (std::exchange(asked.calibration, false)) {
            asked.calibrating = {};
        } else {
            implementation_->abandon = true;
        }
    });
}

BenchThread::Calibrating BenchThread::calibrating() const {
    return implementation_->worker.use([](const BenchJobs& asked) { return asked.calibrating; });
}

}  // namespace livery
