// What the tests of the drawing threads share: contexts of one group, and finished pictures.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

#include "gl/context.h"
#include "support/gl_device.h"

namespace livery::testing {

/// Two contexts of a share group: the test's stays current, the thread's is free.
struct SharedContexts {
    HeadlessContext ours{tested_gl()};
    HeadlessContext theirs{tested_gl(), &ours};
    SharedContexts() {
        theirs.release();
        ours.make_current();
    }
};

/// What a thread hands out, for the test's thread to wait for.
template <typename T>
class Finished {
  public:
    void add(T value) {
        {
            const std::scoped_lock lock(mutex_);
            values_.push_back(std::move(value));
        }
        wake_.notify_all();
    }
    auto callback() {
        return [this](T value) { add(std::move(value)); };
    }
    /// The first that `fits`, of those that came and those that come within five minutes.
    template <typename Fits>
    T wait_for(const Fits& fits) {
        std::unique_lock lock(mutex_);
        T found{};
        bool done = false;
        std::size_t seen = 0;
        wake_.wait_for(lock, std::chrono::minutes(5), [&] {
            for (; !done && seen < values_.size(); ++seen) {
                if (!fits(values_[seen])) continue;
                found = values_[seen];
                done = true;
            }
            return done;
        });
        return found;
    }
    bool wait_for_count(std::size_t count) {
        std::unique_lock lock(mutex_);
        return wake_.wait_for(
            lock, std::chrono::minutes(5), [&] { return values_.size() >= count; });
    }
    std::vector<T> all() {
        const std::scoped_lock lock(mutex_);
        return values_;
    }

  private:
    std::mutex mutex_;
    std::condition_variable wake_;
    std::vector<T> values_;
};

}  // namespace livery::testing
