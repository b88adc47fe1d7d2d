#include "fuzz/fuzz.h"
#include "mesh/obj_materials.h"

LIVERY_FUZZ(text) {
    livery::ObjColours colours;
    std::vector<std::string> notes;
    livery::read_obj_colours(text, "a.mtl", colours, notes);
    for (const auto& note : notes) {
        livery::fuzz::require(note == livery::printable(note), "notes can be shown");
    }
}
