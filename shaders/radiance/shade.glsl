// Shades one fragment, in the subset of GLSL and C++ (shaders/bsdf/prelude_glsl.glsl): the same lines
// run in OpenGL and, eight fragments at a time, on the processor (src/radiance/lanes/lane_shading.inc).
// Comes after the model's reflectance functions, disc.glsl, these definitions
//   PREPARED          the struct of what the model takes from its parameters once (layers.glsl);
//                     LAMBERT too where it sees all light alike. Else ANY_MODEL, which is called as
//                     it is, with WEIGHTS, MIRRORS and BSDF_TURN2 (src/radiance/shading.cpp)
//   LIGHTS n          directional lights, 0 and more; LIGHT_COUNT, the same as a number
//   ENVIRONMENT       0 or 1: light from all around, by the environment or by other parts
//   MIRRORED          0 or 1: what is mirrored of the environment as well
//   GLINTS            true if flakes of car paint are seen one by one; needs glints.glsl
//   VEC4, UNIFORM     as the language has them
//   IS_NAN(x)         whether x is no number, in a way that no optimiser takes out
// and the inputs of a fragment: inputs_packed.glsl (surface map), inputs_raster.glsl (preview) or
// members of a C++ struct. Directions are in each fragment's own frame: z its mean normal, x its
// tangent. What does not depend on the fragment is a uniform.
UNIFORM REAL u_exposure;  // 2^EV

// Half floats end at 65504. What is no number must stay none, so that it ends black and counted
// (correct.comp) and not as the brightest light there is: what min makes of it is each
// language's, each driver's and each instruction set's own.
FN REAL exposed(REAL value) {
    REAL lit = u_exposure * value;
    return IS_NAN(lit) ? lit : min(lit, R(65000.0));
}
FN VEC3 exposed(VEC3 colour) {
    return VEC3(exposed(colour.x), exposed(colour.y), exposed(colour.z));
}

#ifndef LAMBERT
FN REAL sum_of(VEC3 v) {
    return v.x + v.y + v.z;
}
FN REAL sum_of(VEC4 v) {
    return v.x + v.y + v.z + v.w;
}
// A colour of which a sum of all that it was made from is told: no number where that is none. The
// formulas clamp, and what a clamp makes of no number is a number or not, as each driver likes.
FN VEC3 made_from(REAL inputs, VEC3 colour) {
    return colour + VEC3(IS_NAN(inputs) ? inputs : R(0.0));
}
#endif

#ifdef LAMBERT

UNIFORM PREPARED u_paint;

FN VEC3 shaded() {
    return exposed(MUTATED(shade_lambert, u_paint.diffuse * diffuse_light_here()));
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
    REAL inputs = sum_of(eye);

#if LIGHTS > 0
    for (int k = 0; k < LIGHT_COUNT; ++k) {
        VEC4 light = light_here(k);
        inputs += sum_of(light) + u_light_radius2[k];
        VEC3 wi = VEC3(light.x, light.y, light.z);
        VEC3 h = wi + wo;
        REAL length_h = sqrt(max(dot(h, h), R(1e-8)));
        REAL c = max(h.z / length_h, R(0.5));
        // The light's disc among the half vectors (disc.glsl), as a mean squared slope.
        REAL spread = eye.w + R(0.25) * u_light_radius2[k] / (length_h * c * c * c);
        VEC3 value = bsdf_eval(bsdf_widen(u_paint, BSDF_TURN2 * spread), wi, wo);
        REAL lit = MUTATED(shade_any_lamp, wi.z > R(0.0) ? light.w * wi.z : R(0.0));
        sum += u_light_radiance[k] * value * lit;
    }
#endif

#if ENVIRONMENT
    // What is no number has no index.
    REAL cosine = IS_NAN(wo.z) ? R(0.0) : clamp(wo.z, R(0.0), R(1.0));
    REAL at = sqrt(cosine) * REAL(WEIGHTS - 1);
    int below = min(int(at), WEIGHTS - 2);
    REAL share = at - REAL(below);
    sum += MUTATED(shade_any_sky, mix(u_sky_weight[below], u_sky_weight[below + 1], share)) *
           sky_here();
#if MIRRORS && MIRRORED
    sum += mix(u_mirror_weight[below], u_mirror_weight[below + 1], share) *
           mirrored_here(u_base_layers, u_lobe_alpha);
#endif
#endif
    return exposed(made_from(inputs, sum));
}

#else

UNIFORM PREPARED u_paint;
// Of kMirrorAlphas, for each lobe: the first of four between which it lies, the others' shares
UNIFORM VEC4 u_lobe_layers[MOST_LOBES];
#ifdef GLINTS
UNIFORM REAL u_glint_density;  // flakes on a mm^2 of the mock-up, as large as they are drawn
#endif

FN VEC3 mirrored_by(int lobe, Passage to, REAL mu, MirrorGrazing grazing) {
    VEC2 slopes = slopes_of(u_paint, lobe);
    return MUTATED(shade_mirror, mirror_weight(u_paint, to, mu, grazing, lobe)) *
           mirrored_here(u_lobe_layers[lobe], sqrt(slopes.x * slopes.y));
}

FN VEC3 shaded() {
    VEC4 eye = eye_here();
    VEC3 wo = VEC3(eye.x, eye.y, eye.z);
    Passage to = passage_of(u_paint, wo.z);
    REAL inputs = sum_of(eye);
#ifdef GLINTS
    VEC4 place = GLINTS ? place_here() : eye;
    inputs += sum_of(place);
#endif
    VEC3 sum = VEC3(R(0.0));

#if LIGHTS > 0
    for (int k = 0; k < LIGHT_COUNT; ++k) {
        VEC4 light = light_here(k);
        VEC3 wi = VEC3(light.x, light.y, light.z);
        VEC3 h = wi + wo;
        REAL hh = max(dot(h, h), R(1e-8));
        REAL disc = u_light_radius2[k];
        inputs += sum_of(light) + disc;
        VEC3 lobes = VEC3(R(0.0));
        lobes.x = disc_distribution_visibility(wi, wo, hh, slopes_of(u_paint, 0), disc, eye.w);
        if (lobe_count(u_paint) > 1) {
            lobes.y = disc_distribution_visibility(wi, wo, hh, slopes_of(u_paint, 1), disc, eye.w);
        }
        if (lobe_count(u_paint) > 2) {
            lobes.z = disc_distribution_visibility(wi, wo, hh, slopes_of(u_paint, 2), disc, eye.w);
        }
#ifdef GLINTS
        if (GLINTS) {
            lobes.z *= glint_factor(wi,
                                    wo,
                                    hh,
                                    slopes_of(u_paint, FLAKE_LOBE).x,
                                    disc,
                                    eye.w,
                                    place,
                                    u_glint_density);
        }
#endif
        VEC3 value = reflected(u_paint, passage_of(u_paint, wi.z), to, hh, lobes);
        VEC3 seen = u_light_radiance[k] * value;
        REAL lit = MUTATED(shade_lamp, light.w * max(wi.z, R(0.0)));
        // A light that is not seen may give no number at all.
        sum += VEC3(lit == R(0.0) ? R(0.0) : lit * seen.x,
                    lit == R(0.0) ? R(0.0) : lit * seen.y,
                    lit == R(0.0) ? R(0.0) : lit * seen.z);
    }
#endif

    if (ENVIRONMENT != 0) {
        sum += MUTATED(shade_sky, sky_weight(u_paint, to) * sky_here());
    }
    if (ENVIRONMENT != 0 && MIRRORED != 0) {
        MirrorGrazing grazing;
        grazing.narrow = grazing_here(0);
        grazing.middle = grazing_here(1);
        grazing.wide = grazing_here(2);
        grazing.entry = grazing_here(3);
        inputs += sum_of(grazing.narrow) + sum_of(grazing.middle) + sum_of(grazing.wide) +
                  sum_of(grazing.entry);
        sum += mirrored_by(0, to, wo.z, grazing);
        if (lobe_count(u_paint) > 1) sum += mirrored_by(1, to, wo.z, grazing);
        if (lobe_count(u_paint) > 2) sum += mirrored_by(2, to, wo.z, grazing);
    }
    return exposed(made_from(inputs, sum));
}

#endif
