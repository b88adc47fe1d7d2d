#include "fuzz/fuzz.h"
#include "twin/description.h"

LIVERY_FUZZ(text) { livery::parse_bench(text, "/no folder/a.json"); }
