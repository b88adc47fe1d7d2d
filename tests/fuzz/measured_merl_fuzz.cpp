#include "appearance/measured/measured_merl.h"
#include "fuzz/fuzz.h"

/// Every input is shorter than a table, so none may be taken for one.
LIVERY_FUZZ(bytes) {
    livery::parse_merl(bytes, "a.binary");
    livery::fuzz::require(false, "a short table is refused");
}
