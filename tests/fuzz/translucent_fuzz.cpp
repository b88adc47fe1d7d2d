#include "appearance/subsurface/translucent_material.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    const auto material = livery::parse_translucent_material(text, "a.json");
    for (int channel = 0; channel < 3; ++channel) {
        livery::check_medium(livery::medium_of(material, channel));
    }
}
