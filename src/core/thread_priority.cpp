#include "core/thread_priority.h"

#include <cstdlib>

#include <sys/resource.h>
#include <unistd.h>

namespace livery {

void set_nice_of_this_thread(int nice) {
    static const bool equal = std::getenv("LIVERY_EQUAL_PRIORITIES") != nullptr;
    // On Linux a "process" here is a thread; 0 is the calling one.
    if (!equal) setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice);
}

}  // namespace livery
