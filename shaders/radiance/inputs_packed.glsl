// Inputs of a fragment from the packed textures: what does not depend on the paint was solved
// beforehand (src/radiance/fragment_inputs.cpp).
#if LIGHTS > 0
uniform vec3 u_light_radiance[LIGHTS];  // irradiance, facing the light
uniform float u_light_radius2[LIGHTS];  // half of the disc's angle, squared
#endif

#ifdef LAMBERT

uniform sampler2D u_lit;

// Radiance of a white diffuser, all lights and environment.
vec3 diffuse_light_here() {
    return texelFetch(u_lit, ivec2(gl_FragCoord.xy), 0).rgb;
}

#else

uniform sampler2D u_eye;
uniform sampler2DArray u_lights;
uniform sampler2D u_sky;
uniform sampler2DArray u_mirror;
uniform float u_mirror_unit;
uniform int u_mirror_place[MIRROR_LAYERS];  // of each layer in u_mirror; -1: nowhere

// Direction to the eye, mean squared slope of the normals.
vec4 eye_here() {
    return texelFetch(u_eye, ivec2(gl_FragCoord.xy), 0);
}

// Direction to light k, its visibility.
vec4 light_here(int k) {
    return texelFetch(u_lights, ivec3(gl_FragCoord.xy, k), 0);
}

#ifdef GLINTS
uniform sampler2D u_places;

// Position, side of the square that a pixel covers there, in mm.
vec4 place_here() {
    return texelFetch(u_places, ivec2(gl_FragCoord.xy), 0);
}
#endif

// Radiance of a white diffuser under the environment.
vec3 sky_here() {
    return texelFetch(u_sky, ivec2(gl_FragCoord.xy), 0).rgb;
}

vec3 mirror_layer_here(int layer) {
    return texelFetch(u_mirror, ivec3(gl_FragCoord.xy, u_mirror_place[layer]), 0).rgb;
}

// How many times as much of what is mirrored grazes as does of even light, for three lobes each
// (src/radiance/light/mirror_lobes.h). What no paint reads is not there.
vec3 grazing_here(int layer) {
    return u_mirror_place[MIRROR_LOBES + layer] < 0 ? vec3(1.0)
                                                    : mirror_layer_here(MIRROR_LOBES + layer);
}

// What is no number stays none (shade.glsl): max may drop it.
float not_negative(float value) {
    return IS_NAN(value) ? value : max(value, 0.0);
}

// One without a share need not be there.
vec3 share_of(float share, int layer) {
    return share == 0.0 ? vec3(0.0) : share * mirror_layer_here(layer);
}

// Environment over a mirror lobe, between four layers. Their cubic may fall short of nothing beside
// a lamp.
vec3 mirrored_here(vec4 layers, float alpha) {
    int first = int(layers.x);
    vec3 sum = share_of(1.0 - layers.y - layers.z - layers.w, first) +
               share_of(layers.y, first + 1) + share_of(layers.z, first + 2) +
               share_of(layers.w, first + 3);
    return u_mirror_unit * vec3(not_negative(sum.x), not_negative(sum.y), not_negative(sum.z));
}

#endif
