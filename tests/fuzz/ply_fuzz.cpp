#include "fuzz/fuzz_mesh.h"

LIVERY_FUZZ(bytes) { livery::fuzz::read_soundly(bytes, "/no folder/mesh.ply"); }
