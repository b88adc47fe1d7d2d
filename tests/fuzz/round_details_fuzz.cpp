#include "evaluation/report/round_details.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const RoundDetails details = parse_round_details(text, "round.json", 1, {481, 376, 912});
    fuzz::require(details.looks.size() <= 3, "each look once");
    for (const LookDetails& look : details.looks) {
        fuzz::require(look.picture.find('/') == std::string::npos, "pictures stay in the folder");
        fuzz::require(look.picture != "..", "pictures stay in the folder");
    }
}
