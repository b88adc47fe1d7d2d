#if defined(__x86_64__)
#define LIVERY_LANES avx2
#include "radiance/lanes/lane_shading.inc"
#endif
