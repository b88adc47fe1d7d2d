#if defined(__x86_64__)
#define LIVERY_LANES avx2
#include "radiance/lanes/mirror_sums.inc"
// After it: its macros stay
#include "radiance/lanes/lane_shading.inc"
#endif
