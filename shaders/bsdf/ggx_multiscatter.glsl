// GGX whose facets pass light on to one another: what single scattering loses comes back as a wide
// lobe, reciprocal. Kulla and Conty (2017). Needs microfacet.glsl, ggx.glsl. Local coordinates: z
// normal, x tangent.
//
//   f = D F V + F_ms (1 - W(mu_i)) (1 - W(mu_o)) / (pi (1 - W_avg)) + diffuse layer
//
// W is the albedo at f0 = 1 and F_ms = F_avg^2 W_avg / (1 - F_avg (1 - W_avg)) what is left of the
// light after two and more bounces. The fits of W err so that never more comes back than was lost.
// The facets are the same along and across: the loss of stretched ones depends on the azimuth.

FN BsdfParameters ggx_not_stretched(BsdfParameters p) {
    BsdfParameters q = p;
    q.alpha_y = p.alpha_x;
    return q;
}

// 1 - W_avg; under a thousandth, where the fit is mostly error, less comes back than was lost.
FN REAL ggx_multiscatter_average_loss(REAL alpha) {
    return max(ggx_average_loss(alpha), R(0.001));
}

// F_ms; `lost` is 1 - W_avg.
FN VEC3 ggx_many_bounces(BsdfParameters p, REAL lost) {
    REAL f0_max = max_component(p.f0);
    REAL weight = fresnel_average_weight(f0_max);
    VEC3 f = p.f0 * (R(1.0) - weight) + VEC3(grazing_reflectance(f0_max) * weight);
    return f * f * (R(1.0) - lost) / (VEC3(R(1.0)) - f * lost);
}

// What reaches the diffuse layer, at most: 1 - E - F_ms (1 - W), without cancellation. `lost` is
// 1 - W at mu.
FN VEC3 ggx_multiscatter_transmission(BsdfParameters p, VEC3 many, REAL mu, OUT(REAL) lost) {
    REAL rest;
    REAL f0_max = max_component(p.f0);
    ggx_transmission_fit(mu, p.alpha_x, f0_max, lost, rest);
    REAL f90 = grazing_reflectance(f0_max);
    VEC3 through =
        VEC3(R(1.0) - f90) + (VEC3(f90) - many) * lost + (VEC3(f90) - p.f0) * rest;
    return max(through, VEC3(R(0.0)));
}

// Its mean over the hemisphere, at least: the fit of W_avg is up to 0.0024 low.
FN VEC3 ggx_multiscatter_average_transmission(BsdfParameters p, VEC3 many, REAL lost) {
    VEC3 mean = VEC3(R(1.0)) - ggx_interface_average(ggx_not_stretched(p)) -
                many * max(lost - R(0.0024), R(0.0));
    return max(mean, VEC3(R(0.001)));
}

FN VEC3 ggx_multiscatter_eval(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL lost = ggx_multiscatter_average_loss(p.alpha_x);
    VEC3 many = ggx_many_bounces(p, lost);
    REAL lost_i;
    REAL lost_o;
    VEC3 through = ggx_multiscatter_transmission(p, many, wi.z, lost_i) *
                   ggx_multiscatter_transmission(p, many, wo.z, lost_o) /
                   ggx_multiscatter_average_transmission(p, many, lost);
    return ggx_specular(ggx_not_stretched(p), wi, wo, hh) +
           (many * (lost_i * lost_o / lost) + p.diffuse * through) * R(0.3183098861837907);
}

FN BsdfEnvironment ggx_multiscatter_environment(BsdfParameters p, REAL mu) {
    VEC3 many = ggx_many_bounces(p, ggx_multiscatter_average_loss(p.alpha_x));
    REAL lost;
    VEC3 through = ggx_multiscatter_transmission(p, many, mu, lost);
    BsdfEnvironment e;
    e.diffuse = p.diffuse * through + many * lost;
    e.specular = ggx_environment_albedo(ggx_not_stretched(p), mu, R(1.0));
    e.coat = VEC3(R(0.0));
    return e;
}

// Of sampling the single bounce and the rest.
FN VEC2 ggx_multiscatter_chances(BsdfParameters p, REAL mu) {
    BsdfEnvironment e = ggx_multiscatter_environment(p, mu);
    return lobe_chances(e.specular, e.diffuse);
}

FN VEC3 ggx_multiscatter_sample(BsdfParameters p, VEC3 wo, VEC3 u) {
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < ggx_multiscatter_chances(p, wo.z).x) {
        return ggx_sample_lobe(wo, v, p.alpha_x, p.alpha_x);
    }
    return cosine_sample(v);
}

FN REAL ggx_multiscatter_pdf(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC2 chance = ggx_multiscatter_chances(p, wo.z);
    return chance.x * ggx_pdf_lobe(wi, wo, p.alpha_x, p.alpha_x) +
           chance.y * wi.z * R(0.3183098861837907);
}
