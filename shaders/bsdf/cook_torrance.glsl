// Cook-Torrance: f = diffuse / pi + D G F / (4 mu_i mu_o) with Beckmann's distribution of slopes and
// Schlick's Fresnel term. Cook and Torrance (1982); Walter et al. (2007). Needs microfacet.glsl,
// stable.glsl, lobe_albedo.glsl, beckmann.glsl. Local coordinates: z normal, x tangent. Two choices
// of G: Smith's in Walter's rational form (cook_torrance), and the V-shaped grooves of the paper
// (cook_torrance_v_cavity). The diffuse part knows nothing of what the facets take, so both together
// may return more than they receive.

// D F, with |H|^2 = hh.
FN VEC3 beckmann_distribution_fresnel(IN(BsdfParameters) p, VEC3 wi, VEC3 wo, REAL hh) {
    REAL hz = max(wi.z + wo.z, R(1e-6));
    REAL hz2 = hz * hz;
    REAL d = gaussian_slopes(wi.x + wo.x, wi.y + wo.y, hz, p.alpha_x, p.alpha_y) * hh * hh *
             MUTATED(beckmann_norm, R(0.3183098861837907)) /
             (p.alpha_x * p.alpha_y * (hz2 * hz2));
    REAL f90 = grazing_reflectance(max_component(p.f0));
    REAL schlick = schlick_weight(hh);
    return (p.f0 * (R(1.0) - schlick) + VEC3(f90 * schlick)) * d;
}

// Smith's G1 over the cosine: with a = mu / t, t^2 = (ax x)^2 + (ay y)^2, Walter's rational function
// of a below 1.6, else 1.
FN REAL beckmann_masking(VEC3 w, REAL alpha_x, REAL alpha_y) {
    REAL mu = max(w.z, R(1e-6));
    REAL x = alpha_x * w.x;
    REAL y = alpha_y * w.y;
    REAL t = sqrt(x * x + y * y);
    if (mu >= R(1.6) * t) return R(1.0) / mu;
    return min(MUTATED(beckmann_masking, R(3.535) * t + R(2.181) * mu) /
                   (t * t + R(2.276) * mu * t + R(2.577) * mu * mu),
               R(1.0) / mu);
}

FN VEC3 cook_torrance_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL visibility = R(0.25) * beckmann_masking(wi, p.alpha_x, p.alpha_y) *
                      beckmann_masking(wo, p.alpha_x, p.alpha_y);
    return p.diffuse * R(0.3183098861837907) +
           beckmann_distribution_fresnel(p, wi, wo, hh) * visibility;
}

// G = min(1, 2 c mu / (wo.h)) of the lower direction; in terms of H = wi + wo, 2 c / (wo.h) is
// 4 H.z / |H|^2.
FN VEC3 cook_torrance_v_cavity_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL low = max(min(wi.z, wo.z), R(1e-6));
    REAL high = max(max(wi.z, wo.z), R(1e-6));
    REAL visibility = MUTATED(v_cavity_masking, min(R(0.25) / low, h.z / hh) / high);
    return p.diffuse * R(0.3183098861837907) +
           beckmann_distribution_fresnel(p, wi, wo, hh) * visibility;
}

// The facets by their reflectance at the mirror direction.
FN VEC2 cook_torrance_chances(IN(BsdfParameters) p, VEC3 wo) {
    REAL schlick = schlick_weight(R(4.0) * wo.z * wo.z);
    REAL f90 = grazing_reflectance(max_component(p.f0));
    return lobe_chances(p.f0 * (R(1.0) - schlick) + VEC3(f90 * schlick), p.diffuse);
}

FN VEC3 cook_torrance_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    VEC2 v = VEC2(u.x, u.y);
    if (u.z >= cook_torrance_chances(p, wo).x) return cosine_sample(v);
    return beckmann_sample_lobe(wo, v, p.alpha_x, p.alpha_y);
}

FN REAL cook_torrance_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC2 chance = cook_torrance_chances(p, wo);
    return chance.x * beckmann_pdf_lobe(wi, wo, p.alpha_x, p.alpha_y) +
           chance.y * wi.z * R(0.3183098861837907);
}

FN VEC3 cook_torrance_v_cavity_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    return cook_torrance_sample(p, wo, u);
}

FN REAL cook_torrance_v_cavity_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return cook_torrance_pdf(p, wi, wo);
}

LOBE_ALBEDO(cook_torrance_lobe_albedo,
            cook_torrance_eval,
            cook_torrance_sample,
            cook_torrance_pdf)
LOBE_ALBEDO(cook_torrance_v_cavity_lobe_albedo,
            cook_torrance_v_cavity_eval,
            cook_torrance_sample,
            cook_torrance_pdf)

FN BsdfEnvironment cook_torrance_environment(IN(BsdfParameters) p, REAL mu) {
    return diffuse_and_lobe(p.diffuse, cook_torrance_lobe_albedo(p, mu));
}

FN BsdfEnvironment cook_torrance_v_cavity_environment(IN(BsdfParameters) p, REAL mu) {
    return diffuse_and_lobe(p.diffuse, cook_torrance_v_cavity_lobe_albedo(p, mu));
}
