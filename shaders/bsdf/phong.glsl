// Modified Phong: f = diffuse / pi + specular (n + 2) / (2 pi) cos^n of the angle between the mirror
// direction and the eye. Phong (1975), Lafortune and Willems (1994). Needs stable.glsl,
// lobe_albedo.glsl. Local coordinates: z normal, x tangent.

// cos^n: with D from the mirrored light to the eye, 1 - cos = |D|^2 / 2 without cancellation.
FN REAL phong_power(VEC3 wi, VEC3 wo, REAL n) {
    REAL x = wi.x + wo.x;
    REAL y = wi.y + wo.y;
    REAL z = wi.z - wo.z;
    REAL q = R(0.5) * (x * x + y * y + z * z);
    if (q >= R(1.0)) return R(0.0);
    // sin^2 = 1 - cos^2 = q (2 - q)
    REAL c = R(1.0) - q;
    return cosine_power(q * (R(2.0) - q), c * c, n);
}

FN VEC3 phong_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    REAL n = p.exponent_x;
    return p.diffuse * R(0.3183098861837907) +
           p.specular * (MUTATED(phong_norm, n + R(2.0)) * R(0.15915494309189535) *
                         phong_power(wi, wo, n));
}

FN VEC3 phong_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    if (u.z >= lobe_chances(p.specular, p.diffuse).x) return cosine_sample(VEC2(u.x, u.y));
    REAL phi = R(6.283185307179586) * u.x;
    VEC3 l = around_normal(sample_squared_sine(u.y, p.exponent_x), cos(phi), sin(phi));
    // A frame around the mirror direction (Duff et al. 2017); its z is positive.
    VEC3 r = VEC3(-wo.x, -wo.y, max(wo.z, R(0.0)));
    REAL a = -R(1.0) / (R(1.0) + r.z);
    REAL b = r.x * r.y * a;
    VEC3 s = VEC3(R(1.0) + r.x * r.x * a, b, -r.x);
    VEC3 t = VEC3(b, R(1.0) + r.y * r.y * a, -r.y);
    return normalize(s * l.x + t * l.y + r * l.z);
}

FN REAL phong_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC2 chance = lobe_chances(p.specular, p.diffuse);
    REAL n = p.exponent_x;
    return chance.x * (n + R(1.0)) * R(0.15915494309189535) * phong_power(wi, wo, n) +
           chance.y * wi.z * R(0.3183098861837907);
}

LOBE_ALBEDO(phong_lobe_albedo, phong_eval, phong_sample, phong_pdf)

FN BsdfEnvironment phong_environment(IN(BsdfParameters) p, REAL mu) {
    return diffuse_and_lobe(p.diffuse, phong_lobe_albedo(p, mu));
}
