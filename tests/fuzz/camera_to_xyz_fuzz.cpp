#include "calibration/settings.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) { livery::parse_camera_to_xyz(text, "a.json"); }
