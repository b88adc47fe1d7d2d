#include "live/reference_thread.h"

#include <atomic>
#include <exception>
#include <optional>
#include <utility>

#include "core/worker.h"
#include "jobs/comparison.h"
#include "jobs/render/render.h"
#include "live/low_priority.h"

namespace livery {

namespace {

/// A pixel that has not come to rest by then hardly will: an hour on two cores for the car.
constexpr int kMostSamples = 4096;

struct ReferenceJobs {
    std::optional<TraceRequest> request;
    bool tracing = false;
    ReferenceThread::State state;
};

std::shared_ptr<const TracedFrame> traced(const TraceRequest& asked,
                                          double error,
                                          const Progress& progress) {
    RenderRequest request;
    request.scene = asked.scene;
    request.view = asked.setup->view;
    request.backend = RenderBackend::reference;
    request.quality = Quality::reference;
    request.error = error;
    request.samples_per_pixel = kMostSamples;
    if (asked.setup->table) {
        request.stage = FrameStage::projector;
        request.compensation = &*asked.setup->table;
    }
    RenderedFrame frame = render_frame(request, progress);
    auto result = std::make_shared<TracedFrame>();
    result->number = asked.number;
    result->error = error;
    result->unresolved_fraction = frame.traced->unresolved_fraction;
    result->mean_samples = frame.traced->mean_samples;
    result->plan = std::move(frame.plan);
    result->compensation = frame.compensation;
    result->ms_total = frame.ms_total;
    if (!asked.setup->table) srgb_from_working_into(frame.radiance_working, &frame.drive);
    result->drive = std::make_shared<const Image8>(std::move(frame.drive));
    result->radiance_working = std::make_shared<const ImageF>(std::move(frame.radiance_working));
    return result;
}

}  // namespace

struct ReferenceThread::Implementation {
    std::function<void()> on_change;
    std::atomic<bool> stopped{false};  ///< the trace that runs

    Worker<ReferenceJobs> worker;

    void answer(const TraceRequest& asked);
};

void ReferenceThread::Implementation::answer(const TraceRequest& asked) {
    Progress progress;
    progress.stop = &stopped;
    progress.report = [this](double fraction, std::string_view) {
        worker.use([&](ReferenceJobs& jobs) { jobs.state.fraction = fraction; });
    };
    std::string problem;
    try {
        for (const double error : asked.errors) {
            worker.use([&](ReferenceJobs& jobs) {
                jobs.state.fraction = 0.0;
                jobs.state.error = error;
            });
            const auto frame = traced(asked, error, progress);
            worker.use([&](ReferenceJobs& jobs) { jobs.state.newest = frame; });
            on_change();
        }
    } catch (const Cancelled&) {
    } catch (const std::exception& failure) {
        problem = failure.what();
    }
    worker.use([&](ReferenceJobs& jobs) {
        jobs.tracing = false;
        // Asked for again meanwhile: it goes on running
        jobs.state.running = jobs.request.has_value();
        jobs.state.problem = problem;
    });
    on_change();
}

ReferenceThread::ReferenceThread(std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& it = *implementation_;
    it.on_change = std::move(on_change);
    it.worker.start([&it] {
        lower_priority_of_this_thread(Urgency::background);
        it.worker.serve([&it](ReferenceJobs& jobs) -> Worker<ReferenceJobs>::Turn {
            if (!jobs.request) return {};
            it.stopped = false;
            jobs.tracing = true;
            return {[&it, request = *std::exchange(jobs.request, std::nullopt)] {
                it.answer(request);
            }};
        });
    });
}

ReferenceThread::~ReferenceThread() {
    implementation_->worker.stop();  // first: the next trace would take `stopped` back
    implementation_->stopped = true;
}

void ReferenceThread::trace(TraceRequest request) {
    implementation_->worker.change([&](ReferenceJobs& jobs) {
        implementation_->stopped = true;
        jobs.request = std::move(request);
        jobs.state.running = true;
        jobs.state.problem.clear();
    });
}

void ReferenceThread::stop() {
    implementation_->worker.use([&](ReferenceJobs& jobs) {
        implementation_->stopped = true;
        jobs.request.reset();
        jobs.state.running = jobs.tracing;
    });
}

ReferenceThread::State ReferenceThread::state() const {
    return implementation_->worker.use([](const ReferenceJobs& jobs) { return jobs.state; });
}

}  // namespace livery
