// Long arrays lie in textures row by row, MESH_ROW texels each.
ivec2 place_of(uint index) {
    return ivec2(index % uint(MESH_ROW), index / uint(MESH_ROW));
}
