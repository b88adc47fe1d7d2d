#include "fuzz/fuzz.h"
#include "twin/painted_sphere.h"

LIVERY_FUZZ(text) { livery::parse_spectral_paint(text, "/no folder/a.json"); }
