// Inputs of a fragment from the rasterised mesh: interpolated vertices, light directions as they
// are, openness and shadows solved at the vertices.
in vec3 v_position_mm;
in vec3 v_normal;
in vec4 v_tangent;
in vec4 v_sky;  // radiance of a white diffuser under the environment; openness
uniform vec3 u_eye_mm;
uniform vec3 u_view_centre_mm;

#if LIGHTS > 0
in float v_visibility[LIGHTS];
uniform vec3 u_light_direction[LIGHTS];
uniform vec3 u_light_radiance[LIGHTS];  // irradiance, facing the light
uniform float u_light_radius2[LIGHTS];  // half of the disc's angle, squared
#endif

// The seen side is the shaded side.
vec3 normal_here() {
    vec3 flat_normal = cross(dFdx(v_position_mm), dFdy(v_position_mm));
    float seen = dot(flat_normal, u_view_centre_mm - v_position_mm) * dot(flat_normal, v_normal);
    return normalize(v_normal) * (seen < 0.0 ? -1.0 : 1.0);
}

vec3 sky_here() {
    return v_sky.rgb;
}

#ifdef LAMBERT

vec3 diffuse_light_here() {
    vec3 n = normal_here();
    vec3 sum = sky_here();
#if LIGHTS > 0
    for (int k = 0; k < LIGHTS; ++k) {
        sum += u_light_radiance[k] *
               (0.3183098861837907 * v_visibility[k] * max(dot(n, u_light_direction[k]), 0.0));
    }
#endif
    return sum;
}

#else

uniform sampler2DArray u_layers;
uniform float u_layers_unit;
uniform float u_rotation;  // of the environment about +y

vec3 to_local(vec3 direction) {
    vec3 n = normal_here();
    vec3 s = normalize(v_tangent.xyz - dot(v_tangent.xyz, n) * n);
    vec3 t = sign(v_tangent.w) * cross(n, s);
    return vec3(dot(direction, s), dot(direction, t), dot(direction, n));
}

// Toward the eye, kept above the horizon.
vec3 eye_in_world() {
    vec3 n = normal_here();
    vec3 wo = normalize(u_eye_mm - v_position_mm);
    float cosine = dot(n, wo);
    return cosine < 1e-4 ? normalize(wo + (1e-4 - cosine) * n) : wo;
}

// Mean squared slope from the neighbouring pixels, as a square footprint has it.
float slope_variance() {
    vec3 n = normal_here();
    vec3 dx = dFdx(n), dy = dFdy(n);
    return (dot(dx, dx) + dot(dy, dy)) * (1.0 / 12.0);
}

vec4 eye_here() {
    vec3 wo = to_local(eye_in_world());
    return vec4(wo.xy, max(wo.z, 0.5e-4), slope_variance());
}

vec4 light_here(int k) {
#if LIGHTS > 0
    return vec4(to_local(u_light_direction[k]), v_visibility[k]);
#else
    return vec4(0.0);
#endif
}

vec3 mirrored_here(vec2 unused_layer, float alpha) {
    vec3 n = normal_here();
    vec3 d = reflect(-eye_in_world(), n);
    vec2 at = vec2((atan(d.x, -d.z) + u_rotation) * 0.15915494309189535 + 0.5,
                   atan(length(d.xz), d.y) * 0.3183098861837907);
    float wide = sqrt(alpha * alpha + slope_variance());
    float layer = min(wide < FIRST_ALPHA ? wide / FIRST_ALPHA
                                         : 1.0 + 2.0 * log2(wide / FIRST_ALPHA),
                      float(LAYERS) - 1.001);
    float below = floor(layer);
    return u_layers_unit * v_sky.a *
           mix(textureLod(u_layers, vec3(at, below), 0.0).rgb,
               textureLod(u_layers, vec3(at, below + 1.0), 0.0).rgb,
               layer - below);
}

#endif
