// Shades the fragments of one part: one rectangle of the packed textures. Comes after the model's
// reflectance functions (bsdf_glsl) and these definitions:
//   LAMBERT, GGX or CLEARCOAT   the part's model
//   LIGHTS n                    directional lights, 0 and more (not for LAMBERT)
//   ENVIRONMENT 0 or 1
// Directions are in each fragment's own frame: z its mean normal, x its tangent. What does not
// depend on the paint was solved beforehand; what does not depend on the fragment is a uniform.
uniform float u_exposure;  // 2^EV
uniform vec3 u_diffuse;    // what the diffuse layer sends for irradiance pi; see each model
layout(location = 0) out vec4 radiance;

// Half floats end at 65504.
void write_radiance(vec3 colour) {
    radiance = vec4(min(u_exposure * colour, vec3(65000.0)), 1.0);
}

#ifdef LAMBERT

uniform sampler2D u_lit;  // radiance of a white diffuser, all lights and environment

void main() {
    write_radiance(u_diffuse * texelFetch(u_lit, ivec2(gl_FragCoord.xy), 0).rgb);
}

#else

uniform vec3 u_f0;
uniform vec4 u_alpha;  // x, y, coat, coat's f0
uniform sampler2D u_eye;  // wo, mean squared slope of the normals

#if LIGHTS > 0
uniform sampler2DArray u_lights;       // wi, visibility
uniform vec3 u_light_radiance[LIGHTS]; // irradiance, facing the light
uniform float u_light_radius2[LIGHTS]; // half of the disc's angle, squared
#endif

#if ENVIRONMENT
uniform vec3 u_sky_diffuse;       // as u_diffuse, under light from everywhere
uniform sampler2D u_sky;          // radiance of a white diffuser
uniform sampler2DArray u_mirror;  // mean radiance over mirror lobes of several alphas
uniform float u_mirror_unit;
uniform vec2 u_base_layer;        // the lobe's lower layer, and the weight of the next
uniform vec2 u_coat_layer;

vec3 mirrored(ivec2 at, vec2 layer) {
    int below = int(layer.x);
    return u_mirror_unit * mix(texelFetch(u_mirror, ivec3(at, below), 0).rgb,
                               texelFetch(u_mirror, ivec3(at, below + 1), 0).rgb,
                               layer.y);
}
#endif

BsdfParameters paint() {
    BsdfParameters p;
    p.diffuse = u_diffuse;
    p.f0 = u_f0;
    p.alpha_x = u_alpha.x;
    p.alpha_y = u_alpha.y;
    p.coat_alpha = u_alpha.z;
    p.coat_f0 = u_alpha.w;
    p.coat_transmittance = vec3(1.0);
    return p;
}

#ifdef CLEARCOAT
uniform vec3 u_coat_log_transmittance;  // base 2
uniform float u_coat_inverse_index_squared;

// Through the coat once: its interface and its absorption.
vec3 through_coat(BsdfParameters p, float mu) {
    return coat_transmission(p, mu) *
           exp2(u_coat_log_transmittance * coat_path(mu, u_coat_inverse_index_squared));
}
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 eye = texelFetch(u_eye, at, 0);
    vec3 wo = eye.xyz;
    BsdfParameters p = paint();
    float f90 = grazing_reflectance(max_component(p.f0));
    vec3 layer_o = vec3(1.0) - ggx_interface_albedo(p, wo.z);
#ifdef CLEARCOAT
    float coat_f90 = grazing_reflectance(p.coat_f0);
    vec3 through_o = through_coat(p, wo.z);
#endif
    vec3 sum = vec3(0.0);

#if LIGHTS > 0
    for (int k = 0; k < LIGHTS; ++k) {
        vec4 light = texelFetch(u_lights, ivec3(at, k), 0);
        vec3 wi = light.xyz;
        vec3 h = wi + wo;
        float hh = max(dot(h, h), 1e-8);
        float schlick = schlick_weight(hh);
        vec3 value = mix(p.f0, vec3(f90), schlick) *
                     disc_distribution_visibility(
                         wi, wo, hh, p.alpha_x, p.alpha_y, u_light_radius2[k], eye.w);
        value += u_diffuse * layer_o * (vec3(1.0) - ggx_interface_albedo(p, wi.z)) *
                 0.3183098861837907;
#ifdef CLEARCOAT
        value *= through_o * through_coat(p, wi.z);
        value += mix(p.coat_f0, coat_f90, schlick) *
                 disc_distribution_visibility(
                     wi, wo, hh, p.coat_alpha, p.coat_alpha, u_light_radius2[k], eye.w);
#endif
        float lit = wi.z > 0.0 ? light.w * wi.z : 0.0;
        sum += lit > 0.0 ? lit * u_light_radiance[k] * value : vec3(0.0);
    }
#endif

#if ENVIRONMENT
    vec3 base = ggx_environment_albedo(p, wo.z) * mirrored(at, u_base_layer);
    vec3 diffuse = u_sky_diffuse * layer_o * texelFetch(u_sky, at, 0).rgb;
#ifdef CLEARCOAT
    sum += through_o * (base * through_o + diffuse);
    sum += coat_albedo(p, wo.z) * mirrored(at, u_coat_layer);
#else
    sum += base + diffuse;
#endif
#endif
    write_radiance(sum);
}

#endif
