#include "studio/kit/background.h"

#include <deque>
#include <utility>
#include <vector>

#include "core/memory.h"
#include "core/worker.h"

namespace livery {

namespace {

struct BackgroundJob {
    Background::Work work;
    std::function<void(std::exception_ptr)> failed;
};

struct BackgroundJobs {
    std::deque<BackgroundJob> waiting;
    std::vector<Background::Then> results;
    bool working = false;
};

Background::Then result_of(const BackgroundJob& job, const std::atomic<bool>* stop) {
    Progress progress;
    progress.stop = stop;
    try {
        return job.work(progress);
    } catch (...) {
        return [failed = job.failed, why = std::current_exception()] { failed(why); };
    }
}

}  // namespace

struct Background::State {
    std::function<void()> wake;
    Worker<BackgroundJobs> worker;

    void work_off(BackgroundJob job) {
        Then then = result_of(job, worker.stopping());
        job = {};  // and all that it holds
        return_freed_memory();
        worker.use([&](BackgroundJobs& jobs) {
            jobs.working = false;
            jobs.results.push_back(std::move(then));
        });
        wake();
    }
};

Background::Background(std::function<void()> wake) : state_(std::make_unique<State>()) {
    state_->wake = std::move(wake);
    state_->worker.start([state = state_.get()] {
        state->worker.serve([state](BackgroundJobs& jobs) -> Worker<BackgroundJobs>::Turn {
            if (jobs.waiting.empty()) return {};
            BackgroundJob job = std::move(jobs.waiting.front());
            jobs.waiting.pop_front();
            jobs.working = true;
            return {[state, job = std::move(job)]() mutable { state->work_off(std::move(job)); }};
        });
    });
}

Background::~Background() = default;

void Background::run(Work work, std::function<void(std::exception_ptr)> failed) {
    state_->worker.change([&](BackgroundJobs& jobs) {
        jobs.waiting.push_back({std::move(work), std::move(failed)});
    });
}

void Background::take_results() {
    const auto results =
        state_->worker.use([](BackgroundJobs& jobs) { return std::exchange(jobs.results, {}); });
    for (const Then& then : results) {
        if (then) then();
    }
}

bool Background::is_busy() const {
    return state_->worker.use(
        [](const BackgroundJobs& jobs) { return jobs.working || !jobs.waiting.empty(); });
}

}  // namespace livery
