#define LIVERY_LANES portable
#include "radiance/lanes/lane_shading.inc"
