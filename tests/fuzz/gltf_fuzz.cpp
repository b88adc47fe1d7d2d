#include "fuzz/fuzz_mesh.h"

// A GLB where it begins like one, else the text of a .gltf; buffers beside it are never there.
LIVERY_FUZZ(bytes) { livery::fuzz::read_soundly(bytes, "/no folder/mesh.gltf"); }
