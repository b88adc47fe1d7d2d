#include "appearance/material.h"
#include "appearance/material_json.h"
#include "fuzz/fuzz.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const Material material = parse_material(text, "a.json");
    const Json json = json_of(material);
    const Material again = read_material(JsonReader("again.json", json));
    fuzz::require(json_of(again) == json, "what is written is read");
}
