#version 450 core
// Projects the mesh through a view with its lens, vertex by vertex.
layout(location = 0) in vec3 position_mm;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 sky;
uniform mat3 u_view_from_world;
uniform vec3 u_translation_mm;
uniform vec4 u_lens;        // focal length, principal point, in pixels
uniform float u_distortion[5];
uniform vec2 u_size_px;
uniform vec2 u_depth_mm;    // nearest, farthest
out vec3 v_position_mm;
out vec3 v_normal;
out vec4 v_tangent;
out vec4 v_sky;

#if LIGHTS > 0
layout(std430, binding = 0) readonly buffer Visibility {
    float visibility[];
};
out float v_visibility[LIGHTS];
#endif

// Brown-Conrady on the plane z = 1, as src/scene/view.cpp.
vec2 distort(vec2 p) {
    float s = dot(p, p);
    float radial =
        1.0 + s * (u_distortion[0] + s * (u_distortion[1] + s * u_distortion[4]));
    float p1 = u_distortion[2], p2 = u_distortion[3];
    return p * radial + vec2(2.0 * p1 * p.x * p.y + p2 * (s + 2.0 * p.x * p.x),
                             p1 * (s + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y);
}

void main() {
    v_position_mm = position_mm;
    v_normal = normal;
    v_tangent = tangent;
    v_sky = sky;
#if LIGHTS > 0
    for (int k = 0; k < LIGHTS; ++k) v_visibility[k] = visibility[gl_VertexID * LIGHTS + k];
#endif
    vec3 x = u_view_from_world * position_mm + u_translation_mm;
    vec2 pixel = distort(x.xy / x.z) * u_lens.xy + u_lens.zw;
    vec2 ndc = 2.0 * pixel / u_size_px - 1.0;
    float depth = (x.z - u_depth_mm.x) / (u_depth_mm.y - u_depth_mm.x);
    // w = z: attributes are interpolated in perspective. Behind the view: clipped.
    gl_Position = x.z > 0.0 ? vec4(ndc * x.z, (2.0 * depth - 1.0) * x.z, x.z)
                            : vec4(0.0, 0.0, -2.0, 1.0);
}
