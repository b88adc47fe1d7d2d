#include "fuzz/fuzz.h"
#include "ledger/predictions.h"

LIVERY_FUZZ(text) { livery::parse_pass_costs(text, "bench.json"); }
