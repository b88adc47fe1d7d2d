// Measured reflectance on a grid (src/appearance/measured/measured_grid.h), for GLSL alone: C++ has no
// textures. After half_difference.glsl. A layer is one theta_d, a row one theta_h, and columns go
// round phi_d; texels are log2(XYZ + MEASURED_FLOOR). Read without the sampler's own filter,
// which weighs with too few bits.
vec3 measured_row(sampler2DArray grid, int layer, int row, int column, int next, float share) {
    return mix(texelFetch(grid, ivec3(column, row, layer), 0).xyz,
               texelFetch(grid, ivec3(next, row, layer), 0).xyz,
               share);
}

vec3 measured_layer(sampler2DArray grid, int layer, vec3 at, ivec3 size) {
    // What is no number has no index.
    int column = clamp(int(at.z), 0, size.z - 1);
    int next = column + 1 == size.z ? 0 : column + 1;
    int row = clamp(int(at.x), 0, size.x - 2);
    return mix(measured_row(grid, layer, row, column, next, at.z - float(column)),
               measured_row(grid, layer, row + 1, column, next, at.z - float(column)),
               at.x - float(row));
}

vec3 measured_eval(sampler2DArray grid, vec3 wi, vec3 wo) {
    if (wi.z <= 0.0 || wo.z <= 0.0) return vec3(0.0);
    ivec3 texels = textureSize(grid, 0);
    ivec3 size = ivec3(texels.y, texels.z, texels.x);
    vec3 at = half_difference_nodes(half_difference(wi, wo), vec3(size));
    int layer = clamp(int(at.y), 0, size.y - 2);
    vec3 logarithm = mix(measured_layer(grid, layer, at, size),
                         measured_layer(grid, layer + 1, at, size),
                         at.y - float(layer));
    return WORKING_FROM_XYZ * (exp2(logarithm) - vec3(MEASURED_FLOOR));
}
