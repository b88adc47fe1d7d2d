// Memory that was freed goes back to the system.
#pragma once

namespace livery {

/// After work that took hundreds of megabytes for a while. The C library keeps most of what is
/// freed for the thread that freed it, so a program that calibrates now and then would grow by one
/// calibration's photographs for each thread that ever held them. Takes milliseconds; any thread.
void return_freed_memory();

/// From here on blocks of a megabyte and more are the system's own pages, which go back when they
/// are freed. Otherwise the C library raises that size to 32 MB after the first large block, keeps
/// them among small ones, and a program that runs for hours holds twice what it uses. For programs
/// that stay open; what allocates large blocks in every frame should keep them.
void keep_large_blocks_apart();

}  // namespace livery
