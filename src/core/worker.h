// Threads that do one thing at a time, always the most urgent that is asked for.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace livery {

/// A value behind a mutex (a monitor) and the threads that take their jobs from it. What an
/// std::optional of the value holds is a job of which the newest wins; a deque is a queue. To be
/// the last member of what its jobs use: its destructor ends the threads.
template <typename State>
class Worker {
  public:
    using Clock = std::chrono::steady_clock;

    /// What a thread is to do next, without the lock; no job: to wait for a change, or until then.
    struct Turn {
        std::function<void()> job;
        std::optional<Clock::time_point> ask_again_at = std::nullopt;
    };

    Worker() = default;
    ~Worker() {
        stop();
        join();
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// One more thread; `body` ends when serve() returns, and lets no exception out.
    void start(std::function<void()> body) { threads_.emplace_back(std::move(body)); }

    /// Does what `next(state)` takes out of the state, one Turn after another, until stop(). What
    /// a job throws ends it, too, and reaches the caller.
    template <typename Next>
    void serve(const Next& next) {
        std::unique_lock lock(mutex_);
        while (!stopping_) {
            Turn turn = next(state_);
            if (turn.job) {
                lock.unlock();
                turn.job();
                turn = {};  // and all that it holds
                lock.lock();
            } else if (turn.ask_again_at) {
                changed_.wait_until(lock, *turn.ask_again_at);
            } else {
                changed_.wait(lock);
            }
        }
    }

    /// `use(state)`, which wakes nobody: to read, and to note what nobody waits for.
    template <typename Use>
    auto use(const Use& use) const {
        const std::scoped_lock lock(mutex_);
        return use(state_);
    }
    template <typename Use>
    auto use(const Use& use) {
        const std::scoped_lock lock(mutex_);
        return use(state_);
    }
    /// The same, and the threads ask again what is next.
    template <typename Change>
    auto change(const Change& change) {
        const Waking waking{changed_};
        return use(change);
    }
    /// Inside of a job: until another thread's change() makes `done(state)` true.
    template <typename Done>
    void wait(const Done& done) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return done(state_); });
    }

    /// No job is begun from now on; returns at once.
    void stop() {
        {
            const std::scoped_lock lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
    }
    /// Waits for the threads to end: what else wakes them may go then, before this does.
    void join() {
        for (std::thread& thread : threads_) thread.join();
        threads_.clear();
    }
    /// For Progress::stop of a job that nothing else ends.
    const std::atomic<bool>* stopping() const { return &stopping_; }

  private:
    struct Waking {
        std::condition_variable& changed;
        ~Waking() { changed.notify_all(); }
    };

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    State state_;
    std::atomic<bool> stopping_{false};
    std::vector<std::thread> threads_;
};

}  // namespace livery
