// Energy-conserving Oren-Nayar: Fujii's qualitative form with the light of many bounces given back.
// Oren and Nayar (1994); Portsmouth, Kutz and Hill (2025). Local coordinates: z normal, x tangent.
//
//   f = rho A / pi (1 + r s / t) + rho_ms / pi (1 - E_i) (1 - E_o) / (1 - E_avg)
//
// with A = 1 / (1 + C1 r). E is the albedo of the first term for rho = 1, exact: a fit of it would
// let white surfaces return more than they receive.

// Integral over the hemisphere behind E: E = A (1 + r G / pi). G falls from pi C1 at grazing
// incidence to 0 at the normal.
FN REAL eon_integral(REAL mu) {
    REAL c = clamp(mu, R(0.0), R(1.0));
    REAL s = sqrt((R(1.0) - c) * (R(1.0) + c));
    // (s / c) (1 - s^3) without its 0 / 0
    REAL last = s * c * (R(1.0) + s + s * s) / (R(1.0) + s);
    return s * (acos(c) - s * c) + R(0.6666666666666667) * (last - s);
}

// (1 - E) / (A r), from 0 at grazing incidence to C1
FN REAL eon_loss(REAL mu) {
    return max(R(0.2877934092108062) - eon_integral(mu) * R(0.3183098861837907), R(0.0));
}

// pi times the value of the light of many bounces over (1 - E_i) (1 - E_o) / (A r)^2
FN VEC3 eon_multiple(IN(BsdfParameters) p, REAL a) {
    VEC3 one = VEC3(R(1.0));
    REAL r = p.diffuse_roughness;
    REAL average = (R(1.0) + R(0.07248821245692394) * r) * a;
    VEC3 rho = p.diffuse * p.diffuse * average / (one - p.diffuse * (R(1.0) - average));
    // C1 - C2, from 1 - E_avg = A r (C1 - C2)
    return MUTATED(eon_multiple, rho * (a * r / R(0.21530519675388227)));
}

FN VEC3 eon_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    REAL r = p.diffuse_roughness;
    REAL a = R(1.0) / (R(1.0) + R(0.2877934092108062) * r);
    REAL s = wi.x * wo.x + wi.y * wo.y;
    REAL t = s > R(0.0) ? max(max(wi.z, wo.z), R(1e-6)) : R(1.0);
    REAL once = MUTATED(eon_single, a * max(R(1.0) + r * s / t, R(0.0)));
    VEC3 value = p.diffuse * once + eon_multiple(p, a) * (eon_loss(wi.z) * eon_loss(wo.z));
    return value * R(0.3183098861837907);
}

FN VEC3 eon_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    return cosine_sample(VEC2(u.x, u.y));
}

FN REAL eon_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    return wi.z * R(0.3183098861837907);
}

FN BsdfEnvironment eon_environment(IN(BsdfParameters) p, REAL mu) {
    REAL r = p.diffuse_roughness;
    REAL a = R(1.0) / (R(1.0) + R(0.2877934092108062) * r);
    REAL once =
        MUTATED(eon_sky_weight, a * (R(1.0) + r * eon_integral(mu) * R(0.3183098861837907)));
    // The mean of the other direction's loss over the hemisphere is C1 - C2.
    BsdfEnvironment e;
    e.diffuse = p.diffuse * once + eon_multiple(p, a) * (eon_loss(mu) * R(0.21530519675388227));
    e.specular = VEC3(R(0.0));
    e.coat = VEC3(R(0.0));
    return e;
}
