#version 450 core
// All samples, at the depth of one part.
uniform float u_part_depth;

void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0,
                       gl_VertexID == 2 ? 3.0 : -1.0,
                       2.0 * u_part_depth - 1.0,
                       1.0);
}
