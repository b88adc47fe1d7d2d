#version 450 core
// Projects the mesh through a view with its lens, vertex by vertex.
#include "radiance/lens.glsl"
layout(location = 0) in vec3 position_mm;
uniform vec2 u_size_px;
uniform vec2 u_depth_mm;  // nearest, farthest

void main() {
    vec3 at = project(position_mm);
    vec2 ndc = 2.0 * at.xy / u_size_px - 1.0;
    float depth = (at.z - u_depth_mm.x) / (u_depth_mm.y - u_depth_mm.x);
    // w = z: lines stay straight in perspective. Behind the view: clipped.
    gl_Position = at.z > 0.0 ? vec4(ndc * at.z, (2.0 * depth - 1.0) * at.z, at.z)
                             : vec4(0.0, 0.0, -2.0, 1.0);
}
