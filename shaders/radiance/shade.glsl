// Shades one fragment, in the subset of GLSL and C++ (shaders/bsdf/prelude_glsl.glsl): the same lines
// run in OpenGL and, eight fragments at a time, on the processor (src/radiance/lanes/lane_shading.inc).
// Comes after the model's reflectance functions, disc.glsl, these definitions
//   LAMBERT, GGX, CLEARCOAT or  the part's model, with what does not depend on the fragment taken
//   CAR_PAINT                   out of it; else ANY_MODEL, which is called as it is, with WEIGHTS,
//                               MIRRORS and BSDF_TURN2 (src/radiance/shading.cpp)
//   LIGHTS n                    directional lights, 0 and more; LIGHT_COUNT, the same as a number
//   ENVIRONMENT 0 or 1
//   GLINTS                      if flakes of car paint are seen one by one; needs glints.glsl
//   VEC4, UNIFORM               as the language has them
//   IS_NAN(x)                   whether x is no number, in a way that no optimiser takes out
// and the inputs of a fragment: inputs_packed.glsl (surface map), inputs_raster.glsl (preview) or
// members of a C++ struct. Directions are in each fragment's own frame: z its mean normal, x its
// tangent. What does not depend on the fragment is a uniform.
UNIFORM REAL u_exposure;  // 2^EV
UNIFORM VEC3 u_diffuse;   // what the diffuse layer sends for irradiance pi; see each model

// Half floats end at 65504. What is no number must stay none, so that it ends black and counted
// (compensation.frag) and not as the brightest light there is: what min makes of it is each
// language's, each driver's and each instruction set's own.
FN REAL exposed(REAL value) {
    REAL lit = u_exposure * value;
    return IS_NAN(lit) ? lit : min(lit, R(65000.0));
}
FN VEC3 exposed(VEC3 colour) {
    return VEC3(exposed(colour.x), exposed(colour.y), exposed(colour.z));
}

#ifdef LAMBERT

FN VEC3 shaded() {
    return exposed(u_diffuse * diffuse_light_here());
}

#elif defined(ANY_MODEL)

UNIFORM BsdfParameters u_paint;
#if ENVIRONMENT
// bsdf_environment under the cosines (k / (WEIGHTS - 1))^2, the base and the coat together
UNIFORM VEC3 u_sky_weight[WEIGHTS];
UNIFORM VEC3 u_mirror_weight[WEIGHTS];
UNIFORM VEC4 u_base_layers;
UNIFORM REAL u_lobe_alpha;
#endif

FN VEC3 shaded() {
    VEC4 eye = eye_here();
    VEC3 wo = VEC3(eye.x, eye.y, eye.z);
    VEC3 sum = VEC3(R(0.0));

#if LIGHTS > 0
    for (int k = 0; k < LIGHT_COUNT; ++k) {
        VEC4 light = light_here(k);
        VEC3 wi = VEC3(light.x, light.y, light.z);
        VEC3 h = wi + wo;
        REAL length_h = sqrt(max(dot(h, h), R(1e-8)));
        REAL c = max(h.z / length_h, R(0.5));
        // The light's disc among the half vectors (disc.glsl), as a mean squared slope.
        REAL spread = eye.w + R(0.25) * u_light_radius2[k] / (length_h * c * c * c);
        VEC3 value = bsdf_eval(bsdf_widen(u_paint, BSDF_TURN2 * spread), wi, wo);
        REAL lit = wi.z > R(0.0) ? light.w * wi.z : R(0.0);
        sum += u_light_radiance[k] * value * lit;
    }
#endif

#if ENVIRONMENT
    REAL at = sqrt(clamp(wo.z, R(0.0), R(1.0))) * REAL(WEIGHTS - 1);
    int below = min(int(at), WEIGHTS - 2);
    REAL share = at - REAL(below);
    sum += mix(u_sky_weight[below], u_sky_weight[below + 1], share) * sky_here();
#if MIRRORS
    sum += mix(u_mirror_weight[below], u_mirror_weight[below + 1], share) *
           mirrored_here(u_base_layers, u_lobe_alpha);
#endif
#endif
    return exposed(sum);
}

#else

UNIFORM VEC3 u_f0;
UNIFORM VEC4 u_alpha;  // x, y, coat, coat's f0
#if ENVIRONMENT
UNIFORM VEC3 u_sky_diffuse;  // as u_diffuse, under light from everywhere
// Of kMirrorAlphas: the first of four lobes between which the paint's lies, the shares of the others
UNIFORM VEC4 u_base_layers;
UNIFORM VEC4 u_coat_layers;
#endif
#if defined(CLEARCOAT) || defined(CAR_PAINT)
#define COATED
#endif
#ifdef CAR_PAINT
UNIFORM VEC4 u_flakes;       // the second lobe's reflectance, its alpha
UNIFORM VEC3 u_flakes_most;  // what its film reflects at most; without one the same
UNIFORM bool u_has_film;
UNIFORM VEC2 u_film;  // thickness in nm, index
#ifdef GLINTS
UNIFORM REAL u_glint_density;  // flakes on a mm^2 of the mock-up, as large as they are drawn
#endif
#if ENVIRONMENT
UNIFORM VEC4 u_flake_layers;
#endif
#endif

FN BsdfParameters paint() {
    BsdfParameters p;
    p.diffuse = u_diffuse;
    p.f0 = u_f0;
    p.alpha_x = u_alpha.x;
    p.alpha_y = u_alpha.y;
    p.coat_alpha = u_alpha.z;
    p.coat_f0 = u_alpha.w;
    p.coat_transmittance = VEC3(R(1.0));
#ifdef CAR_PAINT
    p.flake_f0 = VEC3(u_flakes.x, u_flakes.y, u_flakes.z);
    p.flake_alpha = u_flakes.w;
    p.film_nm = u_film.x;
    p.film_eta = u_film.y;
#endif
    return p;
}

// What the base lets through to the diffuse layer.
FN VEC3 through_base(BsdfParameters p, REAL mu) {
#ifdef CAR_PAINT
    return car_paint_transmission(p, u_flakes_most, mu);
#else
    return ggx_interface_transmission(p, mu);
#endif
}

#if ENVIRONMENT
// What three lobes have, for one in between: each at the end of its interval.
FN REAL between_lobes(REAL below, VEC3 at, REAL alpha, VEC3 begins, VEC3 inverse_widths) {
    VEC3 share = (VEC3(alpha) - begins) * inverse_widths;
    share = min(max(share, VEC3(R(0.0))), VEC3(R(1.0)));
    return mix(mix(mix(below, at.x, share.x), at.y, share.y), at.z, share.z);
}

// A mirror takes light from one direction only.
FN REAL grazing_fresnel(VEC3 narrow, VEC3 middle, VEC3 wide, REAL alpha) {
    // Lobes of .02, .042, .06; .085, .12, .17; .24, .5 and 1
    REAL value = between_lobes(R(1.0),
                               narrow,
                               alpha,
                               VEC3(R(0.0), R(0.02), R(0.042)),
                               VEC3(R(50.0), R(45.454545), R(55.555556)));
    value = between_lobes(value,
                          middle,
                          alpha,
                          VEC3(R(0.06), R(0.085), R(0.12)),
                          VEC3(R(40.0), R(28.571429), R(20.0)));
    return between_lobes(value,
                         wide,
                         alpha,
                         VEC3(R(0.17), R(0.24), R(0.5)),
                         VEC3(R(14.285714), R(3.8461538), R(2.0)));
}

// Lobes of .06, .17 and .5
FN REAL grazing_entry(VEC3 at, REAL alpha) {
    return between_lobes(R(1.0),
                         at,
                         alpha,
                         VEC3(R(0.0), R(0.06), R(0.17)),
                         VEC3(R(16.666667), R(9.0909091), R(3.030303)));
}
#endif

#ifdef COATED
UNIFORM VEC3 u_coat_log_transmittance;  // base 2
UNIFORM REAL u_coat_inverse_index_squared;

// Through the coat once: its interface and its absorption.
FN VEC3 through_coat(BsdfParameters p, REAL mu) {
    return coat_transmission(p, mu) *
           exp2(u_coat_log_transmittance * coat_path(mu, u_coat_inverse_index_squared));
}

#if ENVIRONMENT
// The same for the light that a lobe under it mirrors, on its way in.
FN VEC3 through_coat_into(BsdfParameters p, REAL mu, REAL alpha, VEC3 entry) {
    REAL ratio = grazing_entry(entry, alpha);
    REAL path = coat_entry_path(mu, alpha, u_coat_inverse_index_squared);
    return coat_entry_transmission(p, mu, alpha, ratio) * exp2(u_coat_log_transmittance * path);
}
#endif
#endif

#if ENVIRONMENT && defined(CAR_PAINT)
// What a lobe of flakes returns of the light that it mirrors, through the coat on the way in.
FN VEC3 through_lobe(BsdfParameters p, REAL mu, REAL alpha, VEC3 entry) {
    REAL loss;
    REAL cosine;
    ggx_albedo_fit(mu, alpha, loss, cosine);
    return (R(1.0) - loss) * through_coat_into(p, mu, alpha, entry);
}
#endif

FN VEC3 shaded() {
    VEC4 eye = eye_here();
    VEC3 wo = VEC3(eye.x, eye.y, eye.z);
    BsdfParameters p = paint();
    VEC3 layer_o = through_base(p, wo.z);
#ifdef CAR_PAINT
    VEC3 beside_base = VEC3(R(1.0)) - p.f0;
#ifdef GLINTS
    VEC4 place = place_here();
#endif
#else
    REAL f0_max = max_component(p.f0);
    REAL f90 = grazing_reflectance(f0_max);
#endif
#ifdef COATED
    REAL coat_f90 = grazing_reflectance(p.coat_f0);
    VEC3 through_o = through_coat(p, wo.z);
#endif
    VEC3 sum = VEC3(R(0.0));

#if LIGHTS > 0
    for (int k = 0; k < LIGHT_COUNT; ++k) {
        VEC4 light = light_here(k);
        VEC3 wi = VEC3(light.x, light.y, light.z);
        VEC3 h = wi + wo;
        REAL hh = max(dot(h, h), R(1e-8));
        REAL lobe = disc_distribution_visibility(
            wi, wo, hh, p.alpha_x, p.alpha_y, u_light_radius2[k], eye.w);
#ifdef CAR_PAINT
        VEC3 value = p.f0 * lobe;
        VEC3 flakes = p.flake_f0;
        if (u_has_film) flakes = film_reflectance(p, hh);
        REAL flake_lobe = disc_distribution_visibility(
            wi, wo, hh, p.flake_alpha, p.flake_alpha, u_light_radius2[k], eye.w);
#ifdef GLINTS
        flake_lobe *= glint_factor(
            wi, wo, hh, p.flake_alpha, u_light_radius2[k], eye.w, place, u_glint_density);
#endif
        value += beside_base * flakes * flake_lobe;
#else
        VEC3 value = mix(p.f0, VEC3(f90), fresnel_weight(f0_max, hh)) * lobe;
#endif
        value += u_diffuse * layer_o * through_base(p, wi.z) * R(0.3183098861837907);
#ifdef COATED
        value *= through_o * through_coat(p, wi.z);
        value += VEC3(mix(p.coat_f0, coat_f90, fresnel_weight(p.coat_f0, hh)) *
                      disc_distribution_visibility(
                          wi, wo, hh, p.coat_alpha, p.coat_alpha, u_light_radius2[k], eye.w));
#endif
        VEC3 seen = u_light_radiance[k] * value;
        REAL lit = light.w * max(wi.z, R(0.0));
        // A light that is not seen may give no number at all.
        sum += VEC3(lit == R(0.0) ? R(0.0) : lit * seen.x,
                    lit == R(0.0) ? R(0.0) : lit * seen.y,
                    lit == R(0.0) ? R(0.0) : lit * seen.z);
    }
#endif

#if ENVIRONMENT
    VEC3 diffuse = u_sky_diffuse * layer_o * sky_here();
    VEC3 narrow = grazing_here(0);
    VEC3 middle = grazing_here(1);
    VEC3 wide = grazing_here(2);
#ifdef COATED
    VEC3 entry = grazing_here(3);
#endif
#ifdef CAR_PAINT
    VEC3 base = p.f0 * mirrored_here(u_base_layers, p.alpha_x) *
                through_lobe(p, wo.z, p.alpha_x, entry);
    VEC3 flakes = p.flake_f0;
    if (u_has_film) flakes = film_reflectance(p, car_paint_mirror_hh(wo.z, p.flake_alpha));
    base += beside_base * flakes * mirrored_here(u_flake_layers, p.flake_alpha) *
            through_lobe(p, wo.z, p.flake_alpha, entry);
    sum += through_o * (base + diffuse);
#else
    REAL alpha = sqrt(p.alpha_x * p.alpha_y);
    REAL more = grazing_fresnel(narrow, middle, wide, alpha);
    VEC3 base = ggx_environment_albedo(p, wo.z, more) * mirrored_here(u_base_layers, alpha);
#ifdef CLEARCOAT
    sum += through_o * (base * through_coat_into(p, wo.z, alpha, entry) + diffuse);
#else
    sum += base + diffuse;
#endif
#endif
#ifdef COATED
    REAL coat_more = grazing_fresnel(narrow, middle, wide, p.coat_alpha);
    sum += coat_albedo(p, wo.z, coat_more) * mirrored_here(u_coat_layers, p.coat_alpha);
#endif
#endif
    return exposed(sum);
}

#endif
