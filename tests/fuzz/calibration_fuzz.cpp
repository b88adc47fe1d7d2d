#include "fuzz/fuzz.h"
#include "scene/colour_calibration.h"

LIVERY_FUZZ(text) { livery::parse_calibration(text, "/no folder/calibration.json"); }
