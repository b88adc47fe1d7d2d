#include "ledger/accuracy/accuracy_thread.h"

#include <atomic>
#include <exception>
#include <string_view>
#include <utility>

#include "core/worker.h"
#include "live/low_priority.h"

namespace livery {

namespace {

struct AccuracyJobs {
    bool asked = false;
    AccuracyThread::State state;
};

}  // namespace

struct AccuracyThread::Implementation {
    std::function<void()> on_change;
    std::atomic<bool> stopped{false};  ///< the measurement that runs

    Worker<AccuracyJobs> worker;

    void measure();
};

void AccuracyThread::Implementation::measure() {
    Progress progress;
    progress.stop = &stopped;
    progress.report = [this](double fraction, std::string_view doing) {
        worker.use([&](AccuracyJobs& jobs) {
            jobs.state.fraction = fraction;
            jobs.state.doing = doing;
        });
    };
    std::string problem;
    bool whole = false;
    try {
        AccuracyOptions options;
        options.quick = true;
        options.folder = accuracy_folder();
        options.on_row = [this](const AccuracyLedger& ledger) {
            auto copy = std::make_shared<const AccuracyLedger>(ledger);
            worker.use([&](AccuracyJobs& jobs) { jobs.state.ledger = std::move(copy); });
            on_change();
        };
        write_accuracy(accuracy_file(), measure_accuracy(options, progress));
        whole = true;
    } catch (const Cancelled&) {
    } catch (const std::exception& failure) {
        problem = failure.what();
    }
    worker.use([&](AccuracyJobs& jobs) {
        jobs.state.running = false;
        jobs.state.whole = whole;
        jobs.state.problem = problem;
    });
    on_change();
}

AccuracyThread::AccuracyThread(std::function<void()> on_change)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& it = *implementation_;
    it.on_change = std::move(on_change);
    it.worker.start([&it] {
        lower_priority_of_this_thread(Urgency::background);
        it.worker.serve([&it](AccuracyJobs& jobs) -> Worker<AccuracyJobs>::Turn {
            if (!std::exchange(jobs.asked, false)) return {};
            it.stopped = false;
            return {[&it] { it.measure(); }};
        });
    });
}

AccuracyThread::~AccuracyThread() {
    implementation_->worker.stop();  // first: the next one would take `stopped` back
    implementation_->stopped = true;
}

void AccuracyThread::measure() {
    implementation_->worker.change([](AccuracyJobs& jobs) {
        if (jobs.state.running) return;
        jobs.asked = true;
        jobs.state = {};
        jobs.state.running = true;
    });
}

void AccuracyThread::stop() {
    implementation_->worker.use([&](AccuracyJobs& jobs) {
        implementation_->stopped = true;
        if (std::exchange(jobs.asked, false)) jobs.state.running = false;
    });
}

AccuracyThread::State AccuracyThread::state() const {
    return implementation_->worker.use([](const AccuracyJobs& jobs) { return jobs.state; });
}

}  // namespace livery
