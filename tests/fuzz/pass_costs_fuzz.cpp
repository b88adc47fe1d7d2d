#include "fuzz/fuzz.h"
#include "ledger/pass_costs.h"

LIVERY_FUZZ(text) { livery::parse_pass_costs(text, "bench.json"); }
