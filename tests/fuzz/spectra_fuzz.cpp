#include "fuzz/fuzz.h"
#include "twin/spectra.h"

LIVERY_FUZZ(text) { livery::parse_spectra_csv(text, "a.csv"); }
