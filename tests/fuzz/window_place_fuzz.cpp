#include "fuzz/fuzz.h"
#include "studio/window/window_place.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const auto place = parse_window_place(text);
    if (place) fuzz::require(parse_window_place(text_of(*place)) == place, "it is read back");
}
