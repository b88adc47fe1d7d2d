#include "fuzz/fuzz.h"
#include "ledger/effect_errors.h"

LIVERY_FUZZ(text) { livery::parse_effect_errors(text, "effect-errors.json"); }
