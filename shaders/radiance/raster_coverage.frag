#version 450 core
// R: 1 where a sample shows one part, A: 1 where it shows anything.
uniform sampler2D u_triangles;
uniform vec2 u_first_last;  // the part's triangles, counted from 1
layout(location = 0) out vec4 coverage;

void main() {
    float triangle = texelFetch(u_triangles, ivec2(gl_FragCoord.xy), 0).r;
    bool of_part = triangle >= u_first_last.x && triangle <= u_first_last.y;
    coverage = vec4(of_part ? 1.0 : 0.0, 0.0, 0.0, triangle > 0.0 ? 1.0 : 0.0);
}
