#include "capture/spot_folder.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) { livery::parse_spot_manifest(text, "/no folder/manifest.json"); }
