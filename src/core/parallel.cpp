#include "core/parallel.h"

#include <atomic>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>

#include <sys/resource.h>
#include <unistd.h>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include "core/error.h"

namespace livery {

namespace {

// The limit lives as long as the program: TBB's control is an object, not a setting.
std::mutex control_mutex;
std::unique_ptr<tbb::global_control> control;

std::atomic<bool> helpers_give_way = false;

/// Once a thread, from inside of it: the scheduler starts its threads when it likes.
void lower_helper() {
    thread_local bool lowered = false;
    if (lowered || !helpers_give_way.load(std::memory_order_relaxed)) return;
    lowered = true;
    set_nice_of_this_thread(10);
}

// What TBB promises and the thread sanitizer cannot see, because TBB is not instrumented: all that
// was done before a loop is seen by its bodies, and what they did is seen after it.
#if defined(__SANITIZE_THREAD__)
void is_done_before(char& order) { __tsan_release(&order); }
void comes_after(char& order) { __tsan_acquire(&order); }
#else
void is_done_before(char&) {}
void comes_after(char&) {}
#endif

}  // namespace

void set_thread_count(int threads) {
    check_argument(threads >= 0, "set_thread_count: threads must be 0 (all) or more");
    const auto count = threads == 0 ? static_cast<std::size_t>(tbb::info::default_concurrency())
                                    : static_cast<std::size_t>(threads);
    const std::scoped_lock lock(control_mutex);
    control =
        std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

int thread_count() {
    return static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void let_helpers_give_way() { helpers_give_way = true; }

void parallel_for(std::size_t count,
                  std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    const auto caller = std::this_thread::get_id();
    char order = 0;
    is_done_before(order);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain == 0 ? 1 : grain),
                      [&](const auto& range) {
                          comes_after(order);
                          if (std::this_thread::get_id() != caller) lower_helper();
                          body(range.begin(), range.end());
                          is_done_before(order);
                      });
    comes_after(order);
}

void set_nice_of_this_thread(int nice) {
    static const bool equal = std::getenv("LIVERY_EQUAL_PRIORITIES") != nullptr;
    // On Linux a "process" here is a thread; 0 is the calling one.
    if (!equal) setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice);
}

}  // namespace livery
