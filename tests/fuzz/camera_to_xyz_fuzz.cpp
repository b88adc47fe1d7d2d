#include "fuzz/fuzz.h"
#include "jobs/camera_to_xyz_file.h"

LIVERY_FUZZ(text) { livery::parse_camera_to_xyz(text, "a.json"); }
