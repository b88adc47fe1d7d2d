#include "core/memory.h"

#include <malloc.h>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace livery {

void ask_for_huge_pages(void* memory, std::size_t bytes) {
#if defined(__linux__)
    madvise(memory, bytes, MADV_HUGEPAGE);
#else
    (void)memory;
    (void)bytes;
#endif
}

void return_freed_memory() { ::malloc_trim(0); }

void keep_large_blocks_apart() { ::mallopt(M_MMAP_THRESHOLD, 1 << 20); }

}  // namespace livery
