#include "fuzz/fuzz_measured.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    fuzz::evaluate_everywhere(parse_spectral_samples(text, "a"), MeasuredFormat::spectral_text);
}
