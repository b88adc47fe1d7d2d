#define LIVERY_LANES portable
#include "radiance/lane_shading.inc"
