#include "core/freed_memory.h"

#include <malloc.h>

namespace livery {

void return_freed_memory() { ::malloc_trim(0); }

void keep_large_blocks_apart() { ::mallopt(M_MMAP_THRESHOLD, 1 << 20); }

}  // namespace livery
