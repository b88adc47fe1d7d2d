#include "fuzz/fuzz_mesh.h"

LIVERY_FUZZ(text) {
    // One that begins like a PLY is one, whatever its suffix says.
    if (!text.starts_with("ply")) livery::fuzz::read_soundly(text, "/no folder/mesh.obj");
}
