#include "fuzz/fuzz_measured.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    fuzz::evaluate_everywhere(parse_measured_csv(text, "a"), MeasuredFormat::csv);
}
