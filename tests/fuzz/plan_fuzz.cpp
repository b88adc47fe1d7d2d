// How a round is presented, as the ballots' log holds it.
#include "evaluation/presenting/presentation.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const PresentationPlan plan = parse_plan(text, "log");
    for (const auto& wave : plan.seats) {
        for (const int seat : wave) fuzz::require(seat >= 0, "a seat is a number");
    }
    fuzz::require(parse_plan(text_of(plan), "log").seats == plan.seats, "seats come back");
}
