#include "capture/stand_folders.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) { livery::parse_spot_manifest(text, "/no folder/manifest.json"); }
