// Ashikhmin and Shirley's anisotropic Phong model (2000). Needs microfacet.glsl, stable.glsl,
// lobe_albedo.glsl. Local coordinates: z normal, x tangent.
//
//   f = sqrt((nu + 1) (nv + 1)) / (8 pi) c^e F / (wo.h max(mu_i, mu_o))
//     + 28 / (23 pi) diffuse (1 - f0) (1 - (1 - mu_i / 2)^5) (1 - (1 - mu_o / 2)^5)
//
// with c = N.h, e = nu cos^2 phi + nv sin^2 phi of h, and Schlick's F.

// c^e: e = (nu hx^2 + nv hy^2) / (1 - c^2) would be 0 / 0 at the peak.
FN REAL ashikhmin_shirley_power(IN(BsdfParameters) p, VEC3 wi, VEC3 wo, REAL hh) {
    REAL hx = wi.x + wo.x;
    REAL hy = wi.y + wo.y;
    REAL hz = wi.z + wo.z;
    REAL x2 = hx * hx / hh;
    REAL y2 = hy * hy / hh;
    return exp(R(0.5) * (p.exponent_x * x2 + p.exponent_y * y2) *
               log_cosine_ratio(x2 + y2, hz * hz / hh));
}

// 1 - (1 - mu / 2)^5
FN REAL ashikhmin_shirley_diffuse(REAL mu) {
    REAL x = R(0.5) * mu;
    return x * (R(5.0) - x * (R(10.0) - x * (R(10.0) - x * (R(5.0) - x))));
}

FN VEC3 ashikhmin_shirley_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL norm = sqrt((p.exponent_x + R(1.0)) * (p.exponent_y + R(1.0)));
    // wo.h = |H| / 2
    REAL lobe = MUTATED(ashikhmin_shirley_norm, norm) * R(0.07957747154594767) *
                ashikhmin_shirley_power(p, wi, wo, hh) /
                (sqrt(hh) * max(max(wi.z, wo.z), R(1e-6)));
    REAL schlick = schlick_weight(hh);
    REAL f90 = grazing_reflectance(max_component(p.f0));
    REAL diffuse = MUTATED(ashikhmin_shirley_diffuse, R(0.387507687528093)) *
                   ashikhmin_shirley_diffuse(wi.z) * ashikhmin_shirley_diffuse(wo.z);
    return (p.f0 * (R(1.0) - schlick) + VEC3(f90 * schlick)) * lobe +
           p.diffuse * (VEC3(R(1.0)) - p.f0) * diffuse;
}

FN VEC3 ashikhmin_shirley_under(IN(BsdfParameters) p, REAL mu) {
    return p.diffuse * (VEC3(R(1.0)) - p.f0) * ashikhmin_shirley_diffuse(mu);
}

FN VEC2 ashikhmin_shirley_chances(IN(BsdfParameters) p, REAL mu) {
    REAL schlick = schlick_weight(R(4.0) * mu * mu);
    REAL f90 = grazing_reflectance(max_component(p.f0));
    return lobe_chances(p.f0 * (R(1.0) - schlick) + VEC3(f90 * schlick),
                        ashikhmin_shirley_under(p, mu));
}

FN VEC3 ashikhmin_shirley_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    if (u.z >= ashikhmin_shirley_chances(p, wo.z).x) return cosine_sample(VEC2(u.x, u.y));
    REAL turn = R(6.283185307179586) * u.x;
    REAL x = sqrt(p.exponent_y + R(1.0)) * cos(turn);
    REAL y = sqrt(p.exponent_x + R(1.0)) * sin(turn);
    REAL scale = R(1.0) / sqrt(x * x + y * y);
    REAL cos_phi = x * scale;
    REAL sin_phi = y * scale;
    REAL n = p.exponent_x * cos_phi * cos_phi + p.exponent_y * sin_phi * sin_phi;
    return mirrored_about(wo, around_normal(sample_squared_sine(u.y, n), cos_phi, sin_phi));
}

FN REAL ashikhmin_shirley_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return R(0.0);
    VEC2 chance = ashikhmin_shirley_chances(p, wo.z);
    REAL norm = sqrt((p.exponent_x + R(1.0)) * (p.exponent_y + R(1.0)));
    REAL lobe = norm * R(0.07957747154594767) * ashikhmin_shirley_power(p, wi, wo, hh) / sqrt(hh);
    return chance.x * lobe + chance.y * wi.z * R(0.3183098861837907);
}

LOBE_ALBEDO(ashikhmin_shirley_lobe_albedo,
            ashikhmin_shirley_eval,
            ashikhmin_shirley_sample,
            ashikhmin_shirley_pdf)

FN BsdfEnvironment ashikhmin_shirley_environment(IN(BsdfParameters) p, REAL mu) {
    return diffuse_and_lobe(ashikhmin_shirley_under(p, mu), ashikhmin_shirley_lobe_albedo(p, mu));
}
