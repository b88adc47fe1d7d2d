#include "fuzz/fuzz.h"
#include "scene/look_json.h"

LIVERY_FUZZ(text) {
    using namespace livery;
    const Look look = parse_look(text, "a.json");
    const Json json = json_of(look);
    fuzz::require(json_of(read_look(JsonReader("again.json", json))) == json,
                  "what is written is read");
}
