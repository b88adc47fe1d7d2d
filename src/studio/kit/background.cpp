#include "studio/kit/background.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "core/freed_memory.h"

namespace livery {

struct Background::State {
    struct Job {
        Work work;
        std::function<void(std::exception_ptr)> failed;
    };
    std::function<void()> wake;
    mutable std::mutex mutex;
    std::condition_variable changed;
    std::deque<Job> jobs;
    std::vector<Then> results;
    bool working = false;
    std::atomic<bool> stop{false};
    std::thread thread;

    void loop() {
        std::unique_lock lock(mutex);
        while (true) {
            changed.wait(lock, [&] { return stop || !jobs.empty(); });
            if (stop) return;
            Job job = std::move(jobs.front());
            jobs.pop_front();
            working = true;
            lock.unlock();
            Then then = result_of(job);
            job = {};  // and all that it holds
            return_freed_memory();
            lock.lock();
            working = false;
            results.push_back(std::move(then));
            lock.unlock();
            wake();
            lock.lock();
        }
    }

    Then result_of(const Job& job) {
        Progress progress;
        progress.stop = &stop;
        try {
            return job.work(progress);
        } catch (...) {
            return [failed = job.failed, why = std::current_exception()] { failed(why); };
        }
    }
};

Background::Background(std::function<void()> wake) : state_(std::make_unique<State>()) {
    state_->wake = std::move(wake);
    state_->thread = std::thread([state = state_.get()] { state->loop(); });
}

Background::~Background() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->stop = true;
    }
    state_->changed.notify_all();
    state_->thread.join();
}

void Background::run(Work work, std::function<void(std::exception_ptr)> failed) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->jobs.push_back({std::move(work), std::move(failed)});
    }
    state_->changed.notify_all();
}

void Background::take_results() {
    std::vector<Then> results;
    {
        const std::lock_guard lock(state_->mutex);
        results.swap(state_->results);
    }
    for (const Then& then : results) {
        if (then) then();
    }
}

bool Background::is_busy() const {
    const std::lock_guard lock(state_->mutex);
    return state_->working || !state_->jobs.empty();
}

}  // namespace livery
