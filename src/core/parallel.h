// Work over all cores, in one place, so that `--threads` reaches everything.
#pragma once

#include <cstddef>
#include <functional>

namespace livery {

/// Sets how many threads parallel_for may use from now on; 0 means all cores.
void set_thread_count(int threads);
int thread_count();

/// From now on the threads that help parallel_for() anywhere in the program give way to all others
/// (nice 10), so that long work in the background takes nothing from a thread that people wait for.
/// Whoever calls parallel_for() takes part in its own loop at its own priority.
void let_helpers_give_way();

/// Calls body(begin, end) over disjoint ranges that cover [0, count). Ranges hold at least `grain`
/// items. Order is free: results must not depend on it. Exceptions reach the caller.
void parallel_for(std::size_t count,
                  std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Gives the calling thread this nice value; threads that it starts inherit it. Where the system
/// refuses, the thread stays as it is: nothing but speed depends on it. With the environment
/// variable LIVERY_EQUAL_PRIORITIES all stay as they are: tests that wait for what is done in the
/// background would otherwise wait for every other test.
void set_nice_of_this_thread(int nice);

}  // namespace livery
