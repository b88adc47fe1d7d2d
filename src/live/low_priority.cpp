#include "live/low_priority.h"

#include "core/parallel.h"

namespace livery {

void lower_priority_of_this_thread(Urgency urgency) {
    set_nice_of_this_thread(urgency == Urgency::watched ? 5 : 15);
}

}  // namespace livery
