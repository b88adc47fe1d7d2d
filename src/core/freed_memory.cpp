#include "core/freed_memory.h"

#include <malloc.h>

namespace livery {

void return_freed_memory() { ::malloc_trim(0); }

}  // namespace livery
