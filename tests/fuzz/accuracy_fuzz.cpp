#include "fuzz/fuzz.h"
#include "ledger/accuracy/accuracy.h"

LIVERY_FUZZ(text) { livery::parse_accuracy(text, "accuracy.json"); }
