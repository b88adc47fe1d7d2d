// GGX whose facets pass light on to one another: what single scattering loses comes back as a wide
// lobe, reciprocal. Kulla and Conty (2017). Needs microfacet.glsl, ggx.glsl. Local coordinates: z
// normal, x tangent.
//
//   f = D F V + F_ms (1 - W(mu_i)) (1 - W(mu_o)) / (pi (1 - W_avg)) + diffuse layer
//
// W is the albedo at f0 = 1 and F_ms = F_avg^2 W_avg / (1 - F_avg (1 - W_avg)) what is left of the
// light after two and more bounces. The fits of W err so that never more comes back than was lost.
// The facets are the same along and across: the loss of stretched ones depends on the azimuth.

struct GgxMultiscatterPrepared {
    GgxPrepared once;  // a single bounce; its diffuse layer over what all bounces let through
    VEC3 many;         // F_ms
    REAL lost;         // 1 - W_avg
};

// 1 - W_avg; under a thousandth, where the fit is mostly error, less comes back than was lost.
FN REAL ggx_multiscatter_average_loss(REAL alpha) {
    return max(ggx_average_loss(alpha), R(0.001));
}

// F_ms; `lost` is 1 - W_avg.
FN VEC3 ggx_many_bounces(IN(GgxPrepared) once, REAL lost) {
    VEC3 f = mix(once.f0, VEC3(once.f90), fresnel_average_weight(once.f0_max));
    return MUTATED(ggx_many_bounces, f * f * (R(1.0) - lost) / (VEC3(R(1.0)) - f * lost));
}

// What reaches the diffuse layer, at most: 1 - E - F_ms (1 - W), without cancellation. `lost` is
// 1 - W at mu.
FN VEC3 ggx_multiscatter_transmission(GgxMultiscatterPrepared q, REAL mu, OUT(REAL) lost) {
    REAL rest;
    ggx_transmission_fit(mu, q.once.layer, q.once.fresnel, lost, rest);
    VEC3 f90 = VEC3(q.once.f90);
    VEC3 through = VEC3(R(1.0)) - f90 + (f90 - q.many) * lost + (f90 - q.once.f0) * rest;
    return max(through, VEC3(R(0.0)));
}

// Its mean over the hemisphere, at least: the fit of W_avg is up to 0.0024 low.
FN VEC3 ggx_multiscatter_average_transmission(GgxMultiscatterPrepared q) {
    VEC3 mean = VEC3(R(1.0)) - ggx_interface_average(q.once) -
                q.many * max(q.lost - R(0.0024), R(0.0));
    return max(mean, VEC3(R(0.001)));
}

FN GgxMultiscatterPrepared ggx_multiscatter_prepare(IN(BsdfParameters) p) {
    BsdfParameters not_stretched = p;
    not_stretched.alpha_y = p.alpha_x;
    GgxMultiscatterPrepared q;
    q.once = ggx_interface(not_stretched);
    q.lost = ggx_multiscatter_average_loss(p.alpha_x);
    q.many = ggx_many_bounces(q.once, q.lost);
    q.once.diffuse = p.diffuse / ggx_multiscatter_average_transmission(q);
    return q;
}

FN VEC3 evaluate(GgxMultiscatterPrepared q, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL lost_i;
    REAL lost_o;
    VEC3 through = ggx_multiscatter_transmission(q, wi.z, lost_i) *
                   ggx_multiscatter_transmission(q, wo.z, lost_o);
    REAL lobe = ggx_distribution_visibility(wi, wo, hh, q.once.alpha_x, q.once.alpha_x);
    VEC3 wide = q.many * (lost_i * lost_o / q.lost) + q.once.diffuse * through;
    return ggx_fresnel(q.once, hh) * lobe + wide * R(0.3183098861837907);
}

FN VEC3 ggx_multiscatter_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return evaluate(ggx_multiscatter_prepare(p), wi, wo);
}

FN BsdfEnvironment ggx_multiscatter_environment(IN(BsdfParameters) p, REAL mu) {
    GgxMultiscatterPrepared q = ggx_multiscatter_prepare(p);
    REAL lost;
    VEC3 through = ggx_multiscatter_transmission(q, mu, lost);
    BsdfEnvironment e;
    e.diffuse = p.diffuse * through + q.many * lost;
    e.specular = mirror_weight(q.once, passage_of(q.once, mu), mu, even_light(), BASE_LOBE);
    e.coat = VEC3(R(0.0));
    return e;
}

// Of sampling the single bounce and the rest.
FN VEC2 ggx_multiscatter_chances(IN(BsdfParameters) p, REAL mu) {
    BsdfEnvironment e = ggx_multiscatter_environment(p, mu);
    return lobe_chances(e.specular, e.diffuse);
}

FN VEC3 ggx_multiscatter_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < ggx_multiscatter_chances(p, wo.z).x) {
        return ggx_sample_lobe(wo, v, p.alpha_x, p.alpha_x);
    }
    return cosine_sample(v);
}

FN REAL ggx_multiscatter_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC2 chance = ggx_multiscatter_chances(p, wo.z);
    return chance.x * ggx_pdf_lobe(wi, wo, p.alpha_x, p.alpha_x) +
           chance.y * wi.z * R(0.3183098861837907);
}
