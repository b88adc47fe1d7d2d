#include "fuzz/fuzz.h"
#include "jobs/pair_geometry.h"

LIVERY_FUZZ(text) { livery::parse_lens_prior(text, "geometry.json"); }
