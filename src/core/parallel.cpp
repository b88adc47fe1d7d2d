#include "core/parallel.h"

#include <memory>
#include <mutex>

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

void parallel_for(std::size_t count,
                  std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain == 0 ? 1 : grain),
                      [&](const auto& range) { body(range.begin(), range.end()); });
}

}  // namespace livery
