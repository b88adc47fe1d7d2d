// Threads that yield to the ones that the projector's picture depends on.
#pragma once

namespace livery {

/// The calling thread gets less of the processor than others when all want it: nice 5 for what a
/// person watches, 15 for what may take its time. Threads that it starts inherit it. Where the
/// system refuses, the thread stays as it is: nothing but speed depends on it.
enum class Urgency { watched, background };
void lower_priority_of_this_thread(Urgency urgency);

}  // namespace livery
