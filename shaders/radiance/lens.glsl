// A view with its lens, as src/scene/view.cpp.
uniform mat3 u_view_from_world;
uniform vec3 u_translation_mm;
uniform vec4 u_lens;  // focal length, principal point, in pixels
uniform float u_distortion[5];

// Brown-Conrady on the plane z = 1.
vec2 distort(vec2 p) {
    float s = dot(p, p);
    float radial =
        1.0 + s * (u_distortion[0] + s * (u_distortion[1] + s * u_distortion[4]));
    float p1 = u_distortion[2], p2 = u_distortion[3];
    return p * radial + vec2(2.0 * p1 * p.x * p.y + p2 * (s + 2.0 * p.x * p.x),
                             p1 * (s + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y);
}

// Pixel and depth of a point of the world.
vec3 project(vec3 position_mm) {
    vec3 x = u_view_from_world * position_mm + u_translation_mm;
    return vec3(distort(x.xy / x.z) * u_lens.xy + u_lens.zw, x.z);
}
