// How much of the processor a thread gets when others want it too.
#pragma once

namespace livery {

/// Gives the calling thread this nice value; threads that it starts inherit it. Where the system
/// refuses, the thread stays as it is: nothing but speed depends on it. With the environment
/// variable LIVERY_EQUAL_PRIORITIES all stay as they are: tests that wait for what is done in the
/// background would otherwise wait for every other test.
void set_nice_of_this_thread(int nice);

}  // namespace livery
