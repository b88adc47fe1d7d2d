#version 450 core
// The preview's radiance as a picture for a window: sRGB, clipped as the program's files are, with
// straight alpha so that any background may stand behind it. Definitions:
//   GROUND 0 or 1     the product darkens the ground that it stands on
//   HIGHLIGHT 0 or 1  one part is outlined, on the part itself
uniform sampler2D u_radiance;  // working space; alpha: coverage
uniform mat3 u_rec709_from_working;
layout(location = 0) out vec4 colour;

#include "srgb.glsl"

#if GROUND
uniform sampler2D u_shadow;        // share of the sky that the product hides from the ground
uniform mat3 u_world_from_pixel;   // direction of a pixel's ray
uniform vec3 u_centre_mm;          // of the view
uniform float u_ground_mm;         // height
uniform vec4 u_shadow_area;        // x, z of its corner in mm; 1 / width, 1 / depth

float shadow_here() {
    vec3 direction = u_world_from_pixel * vec3(gl_FragCoord.xy, 1.0);
    float t = (u_ground_mm - u_centre_mm.y) / direction.y;
    if (!(t > 0.0) || u_centre_mm.y < u_ground_mm) return 0.0;
    vec2 at = (u_centre_mm.xz + t * direction.xz - u_shadow_area.xy) * u_shadow_area.zw;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return 0.0;
    return textureLod(u_shadow, at, 0.0).r;
}
#endif

#if HIGHLIGHT
uniform sampler2D u_part;  // R: share of the covered part of the pixel, A: coverage

float part_at(ivec2 at) {
    vec4 part = texelFetch(u_part, clamp(at, ivec2(0), textureSize(u_part, 0) - 1), 0);
    return part.r * part.a;
}

// Light at the part's edge and dark inside of it: one of the two stands out from any paint. By how
// much of the neighbourhood is not the part, so that its thin gaps (shut lines) get no outline.
vec4 outline_here(float here) {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float other = 0.0, all = 0.0;
    for (int y = -4; y <= 4; ++y) {
        for (int x = -4; x <= 4; ++x) {
            if (x * x + y * y > 16) continue;
            other += 1.0 - part_at(at + ivec2(x, y));
            all += 1.0;
        }
    }
    float share = other / all;
    float light = smoothstep(0.20, 0.28, share), dark = smoothstep(0.08, 0.14, share);
    return vec4(vec3(light), here * mix(0.6 * dark, 1.0, light));
}
#endif

void main() {
    vec4 radiance = texelFetch(u_radiance, ivec2(gl_FragCoord.xy), 0);
    colour = vec4(srgb(u_rec709_from_working * radiance.rgb), radiance.a);
#if HIGHLIGHT
    float part = part_at(ivec2(gl_FragCoord.xy));
    if (part > 0.0) {
        vec4 outline = outline_here(part);
        colour.rgb = mix(colour.rgb, outline.rgb, outline.a);
    }
#endif
#if GROUND
    // Black, behind the product
    float behind = (1.0 - colour.a) * shadow_here();
    float alpha = colour.a + behind;
    colour = vec4(colour.rgb * (colour.a / max(alpha, 1e-6)), alpha);
#endif
}
