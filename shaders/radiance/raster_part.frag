#version 450 core
// Each sample's part as its depth, so that a part's shading runs on its own samples only.
#include "radiance/mesh_texels.glsl"
uniform sampler2D u_triangles;
uniform usampler2D u_corners;

void main() {
    float triangle = texelFetch(u_triangles, ivec2(gl_FragCoord.xy), 0).r;
    // Depths that every float holds exactly; 1: no triangle
    gl_FragDepth = triangle > 0.0
                       ? float(texelFetch(u_corners, place_of(uint(triangle) - 1u), 0).a) / 65536.0
                       : 1.0;
}
