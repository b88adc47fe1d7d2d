#include "fuzz/fuzz.h"
#include "jobs/pair_geometry.h"

LIVERY_FUZZ(text) { livery::parse_made_from_boards(text, "geometry.json"); }
