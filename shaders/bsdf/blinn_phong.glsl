// Blinn-Phong: f = diffuse / pi + specular (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)) (N.H)^n, exactly
// normalised: at normal incidence the lobe's albedo is `specular`. Blinn (1977), Giesen (2009).
// Needs stable.glsl, lobe_albedo.glsl. Local coordinates: z normal, x tangent.

// (N.H)^n; |N x H|^2 from H's tangential components, H = wi + wo unnormalised, hh = |H|^2.
FN REAL blinn_phong_power(VEC3 wi, VEC3 wo, REAL hh, REAL n) {
    REAL hx = wi.x + wo.x;
    REAL hy = wi.y + wo.y;
    REAL hz = wi.z + wo.z;
    return cosine_power((hx * hx + hy * hy) / hh, hz * hz / hh, n);
}

FN VEC3 blinn_phong_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL n = p.exponent_x;
    REAL norm = MUTATED(blinn_phong_norm, n + R(2.0)) * (n + R(4.0)) * R(0.039788735772973836) /
                (exp(-R(0.34657359027997264) * n) + n);
    return p.diffuse * R(0.3183098861837907) +
           p.specular * (norm * blinn_phong_power(wi, wo, hh, n));
}

FN VEC3 blinn_phong_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    if (u.z >= lobe_chances(p.specular, p.diffuse).x) return cosine_sample(VEC2(u.x, u.y));
    REAL phi = R(6.283185307179586) * u.x;
    VEC3 h = around_normal(sample_squared_sine(u.y, p.exponent_x), cos(phi), sin(phi));
    return mirrored_about(wo, h);
}

FN REAL blinn_phong_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return R(0.0);
    VEC2 chance = lobe_chances(p.specular, p.diffuse);
    REAL n = p.exponent_x;
    // Density of h over 4 wo.h, and wo.h = |H| / 2
    return chance.x * (n + R(1.0)) * R(0.07957747154594767) * blinn_phong_power(wi, wo, hh, n) /
               sqrt(hh) +
           chance.y * wi.z * R(0.3183098861837907);
}

LOBE_ALBEDO(blinn_phong_lobe_albedo, blinn_phong_eval, blinn_phong_sample, blinn_phong_pdf)

FN BsdfEnvironment blinn_phong_environment(IN(BsdfParameters) p, REAL mu) {
    return diffuse_and_lobe(p.diffuse, blinn_phong_lobe_albedo(p, mu));
}
