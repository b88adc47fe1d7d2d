// Four at a time, as wide as the registers that every processor has: with eight, each value would
// take two, and this file two minutes to compile.
#define LIVERY_LANE_COUNT 4
#define LIVERY_LANES portable_four
#include "radiance/lanes/lane_shading.inc"
