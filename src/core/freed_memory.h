// Memory that was freed goes back to the system.
#pragma once

namespace livery {

/// After work that took hundreds of megabytes for a while. The C library keeps most of what is
/// freed for the thread that freed it, so a program that calibrates now and then would grow by one
/// calibration's photographs for each thread that ever held them. Takes milliseconds; any thread.
void return_freed_memory();

}  // namespace livery
