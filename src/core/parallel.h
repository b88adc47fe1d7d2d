// Work over all cores, in one place, so that `--threads` reaches everything.
#pragma once

#include <cstddef>
#include <functional>

namespace livery {

/// Sets how many threads parallel_for may use from now on; 0 means all cores.
void set_thread_count(int threads);
int thread_count();

/// Calls body(begin, end) over disjoint ranges that cover [0, count). Ranges hold at least `grain`
/// items. Order is free: results must not depend on it. Exceptions reach the caller.
void parallel_for(std::size_t count,
                  std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace livery
