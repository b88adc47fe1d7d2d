// Shades one part. Comes after the model's reflectance functions (bsdf_glsl), these definitions
//   LAMBERT, GGX or CLEARCOAT   the part's model
//   LIGHTS n                    directional lights, 0 and more
//   ENVIRONMENT 0 or 1
// and the inputs of a fragment: inputs_packed.glsl (surface map) or inputs_raster.glsl (preview).
// Directions are in each fragment's own frame: z its mean normal, x its tangent. What does not
// depend on the fragment is a uniform.
uniform float u_exposure;  // 2^EV
uniform vec3 u_diffuse;    // what the diffuse layer sends for irradiance pi; see each model
layout(location = 0) out vec4 radiance;

// Half floats end at 65504.
void write_radiance(vec3 colour) {
    radiance = vec4(min(u_exposure * colour, vec3(65000.0)), 1.0);
}

#ifdef LAMBERT

void main() {
    write_radiance(u_diffuse * diffuse_light_here());
}

#else

uniform vec3 u_f0;
uniform vec4 u_alpha;  // x, y, coat, coat's f0
#if ENVIRONMENT
uniform vec3 u_sky_diffuse;  // as u_diffuse, under light from everywhere
uniform vec2 u_base_layer;   // of kMirrorAlphas: the lobe's lower layer and the weight of the next
uniform vec2 u_coat_layer;
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
    vec4 eye = eye_here();
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
        vec4 light = light_here(k);
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
    vec3 base = ggx_environment_albedo(p, wo.z) * mirrored_here(u_base_layer, sqrt(p.alpha_x * p.alpha_y));
    vec3 diffuse = u_sky_diffuse * layer_o * sky_here();
#ifdef CLEARCOAT
    // A rough base takes light from higher than the mirror direction (clearcoat_environment).
    float a2 = p.alpha_x * p.alpha_y;
    float mu_in = sqrt((wo.z * wo.z + a2) / (1.0 + a2));
    sum += through_o * (base * through_coat(p, mu_in) + diffuse);
    sum += coat_albedo(p, wo.z) * mirrored_here(u_coat_layer, p.coat_alpha);
#else
    sum += base + diffuse;
#endif
#endif
    write_radiance(sum);
}

#endif
