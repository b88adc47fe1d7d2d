#define LIVERY_LANES portable
#include "radiance/lanes/mirror_sums.inc"
