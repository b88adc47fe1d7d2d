#include "appearance/subsurface/scattering_stack.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    const auto stack = livery::parse_scattering_stack(text, "a.json");
    livery::check_stack(stack);
    const auto whole = livery::merged(stack);
    livery::fuzz::require(whole.layers.size() <= stack.layers.size(), "merging adds no layer");
    livery::fuzz::require(whole.is_slab() == stack.is_slab(), "merging keeps the end");
}
