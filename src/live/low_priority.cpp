#include "live/low_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace livery {

void lower_priority_of_this_thread(Urgency urgency) {
    // On Linux a "process" here is a thread; 0 is the calling one.
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), urgency == Urgency::watched ? 5 : 15);
}

}  // namespace livery
