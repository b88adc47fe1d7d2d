// A clear coat over GGX over a diffuse layer. Needs ggx.glsl. Local coordinates: z normal, x tangent.
//
//   f = f_coat + T(mu_i) T(mu_o) A(mu_i, mu_o) (f_base + f_diffuse),   T = 1 - E_coat
//
// A is the coat's absorption along the refracted path in and out. The base's alpha is the one seen
// through the coat: directions are not refracted. Light that the diffuse layer scatters is partly
// turned back by the coat from inside (R_in), which darkens and saturates it (Saunderson 1942); for
// a white layer the sum of all bounces returns everything, so f_diffuse is
//   (1 - E_b(mu_i)) (1 - E_b(mu_o)) d (1 - R_in) / (pi (1 - d R_in) (1 - max(E_b,avg, E_coat,avg))).
// The base's mirror-like part is seen after one bounce; what the coat returns to it again is lost
// (at most coat_f0 of it).

// Of light of which so many times as much grazes as of even light.
FN REAL coat_albedo(BsdfParameters p, REAL mu, REAL grazing_ratio) {
    REAL white;
    REAL grazing;
    ggx_albedo(mu, p.coat_alpha, p.coat_f0, white, grazing);
    grazing = min(grazing * grazing_ratio, white);
    REAL f90 = grazing_reflectance(p.coat_f0);
    return p.coat_f0 * (white - grazing) + f90 * grazing;
}

FN REAL coat_transmission(BsdfParameters p, REAL mu) {
    REAL loss;
    REAL rest;
    ggx_transmission_fit(mu, p.coat_alpha, p.coat_f0, loss, rest);
    REAL f90 = grazing_reflectance(p.coat_f0);
    return (R(1.0) - f90) + f90 * loss + (f90 - p.coat_f0) * rest;
}

FN REAL coat_average_transmission(BsdfParameters p) {
    REAL white;
    REAL grazing;
    ggx_average_albedo(p.coat_alpha, p.coat_f0, white, grazing);
    REAL f90 = grazing_reflectance(p.coat_f0);
    return R(1.0) - p.coat_f0 * (white - grazing) - f90 * grazing;
}

// 1 / n^2 of the coat.
FN REAL coat_inverse_index_squared(BsdfParameters p) {
    REAL r = sqrt(p.coat_f0);
    REAL n = (R(1.0) - r) / (R(1.0) + r);
    return n * n;
}

// Length of the refracted path through a coat of thickness 1.
FN REAL coat_path(REAL mu, REAL inverse_index_squared) {
    REAL cos2 = R(1.0) - (R(1.0) - mu * mu) * inverse_index_squared;
    return R(1.0) / sqrt(max(cos2, R(1e-4)));
}

FN VEC3 coat_absorption(BsdfParameters p, REAL path) {
    return pow(max(p.coat_transmittance, VEC3(R(1e-6))), VEC3(path));
}

// The diffuse layer's albedo with the coat's inner reflections, over the share of light that passes
// the interfaces.
FN VEC3 coated_diffuse_over(BsdfParameters p, REAL inverse_index_squared, VEC3 share) {
    REAL inside = R(1.0) - coat_average_transmission(p) * inverse_index_squared;
    return p.diffuse * (R(1.0) - inside) / ((VEC3(R(1.0)) - p.diffuse * inside) * share);
}

FN VEC3 coated_diffuse(BsdfParameters p, REAL inverse_index_squared) {
    VEC3 share = min(VEC3(R(1.0)) - ggx_interface_average(p), VEC3(coat_average_transmission(p)));
    return coated_diffuse_over(p, inverse_index_squared, share);
}

// Light from all around that a GGX lobe under the coat sends to mu enters under many cosines. One
// stands for them all, by what the coat transmits of it on the mean, and another by the path: where
// much arrives at grazing angles the mean direction would pass up to 5% too much. Squared, both are
// smooth in mu; fits of our own quadrature of even light (index 1.5, alpha .01 to 1), of its
// transmission within .4% and of its path within .3%, twice as much for mu < .15.
FN REAL coat_entry_cosine(REAL mu, REAL alpha) {
    REAL y = alpha / (alpha + R(0.3));
    REAL c0 = y * (R(0.0045) + y * (R(1.3184) + y * (R(-1.3776) + y * R(-0.1443))));
    REAL c1 = y * (R(-0.2752) + y * (R(-6.9299) + y * (R(23.2973) + y * R(-16.975))));
    REAL c2 = y * (R(1.9661) + y * (R(4.1632) + y * (R(-40.2442) + y * R(36.8058))));
    REAL c3 = y * (R(-4.1456) + y * (R(4.8188) + y * (R(15.85) + y * R(-19.0556))));
    REAL squared = mu * mu + c0 + mu * (c1 + mu * (c2 + mu * c3));
    return sqrt(clamp(squared, R(0.0), R(1.0)));
}

// What the coat transmits of it where so many times as much grazes as of even light.
FN REAL coat_entry_transmission(BsdfParameters p, REAL mu, REAL alpha, REAL grazing_ratio) {
    REAL even = coat_transmission(p, coat_entry_cosine(mu, alpha));
    REAL grazing = R(1.0) - p.coat_f0 - even;
    return clamp(even + grazing * (R(1.0) - grazing_ratio), R(0.0), R(1.0));
}

FN REAL coat_entry_path(REAL mu, REAL alpha, REAL inverse_index_squared) {
    REAL y = alpha / (alpha + R(0.3));
    REAL c0 = y * (R(0.1524) + y * (R(2.3192) + y * R(-2.5349)));
    REAL c1 = y * (R(-1.2958) + y * (R(2.3516) + y * R(-0.4029)));
    REAL c2 = y * (R(1.2878) + y * (R(-7.4003) + y * R(4.9449)));
    REAL squared = mu * mu + c0 + mu * (c1 + mu * c2);
    return coat_path(sqrt(clamp(squared, R(0.0), R(1.0))), inverse_index_squared);
}

// The coat's own lobe. hh = |wi + wo|^2.
FN REAL coat_lobe(BsdfParameters p, VEC3 wi, VEC3 wo, REAL hh) {
    REAL weight = fresnel_weight(p.coat_f0, hh);
    REAL fresnel = p.coat_f0 * (R(1.0) - weight) + grazing_reflectance(p.coat_f0) * weight;
    return fresnel * ggx_distribution_visibility(wi, wo, hh, p.coat_alpha, p.coat_alpha);
}

// What passes the coat both ways.
FN VEC3 coat_passed(BsdfParameters p, REAL mu_i, REAL mu_o, REAL inverse_index_squared) {
    REAL path = coat_path(mu_i, inverse_index_squared) + coat_path(mu_o, inverse_index_squared);
    return coat_absorption(p, path) * (coat_transmission(p, mu_i) * coat_transmission(p, mu_o));
}

FN VEC3 clearcoat_eval(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL coat = coat_lobe(p, wi, wo, hh);
    REAL eta = coat_inverse_index_squared(p);
    VEC3 passed = coat_passed(p, wi.z, wo.z, eta);
    VEC3 diffuse = coated_diffuse(p, eta) * ggx_interface_transmission(p, wi.z) *
                   ggx_interface_transmission(p, wo.z) * R(0.3183098861837907);
    return VEC3(coat) + passed * (ggx_specular(p, wi, wo, hh) + diffuse);
}

FN BsdfEnvironment clearcoat_environment(BsdfParameters p, REAL mu) {
    REAL eta = coat_inverse_index_squared(p);
    REAL path = coat_path(mu, eta);
    REAL passed = coat_transmission(p, mu);
    REAL alpha = sqrt(p.alpha_x * p.alpha_y);
    BsdfEnvironment e;
    e.coat = VEC3(coat_albedo(p, mu, R(1.0)));
    e.specular = ggx_environment_albedo(p, mu, R(1.0)) *
                 coat_absorption(p, path + coat_entry_path(mu, alpha, eta)) *
                 (passed * coat_transmission(p, coat_entry_cosine(mu, alpha)));
    // The diffuse layer is lit from everywhere: absorbed along the path of the mean cosine, 2/3.
    VEC3 one = VEC3(R(1.0));
    VEC3 share =
        min(one - ggx_interface_average(p), VEC3(coat_average_transmission(p)));
    e.diffuse = coated_diffuse(p, eta) * share * ggx_interface_transmission(p, mu) *
                coat_absorption(p, path + coat_path(R(0.6666666666666667), eta)) * passed;
    return e;
}

// Chances of the coat, the base and the diffuse layer when a direction is sampled.
FN VEC3 clearcoat_probabilities(BsdfParameters p, REAL mu) {
    BsdfEnvironment e = clearcoat_environment(p, mu);
    VEC3 chance =
        VEC3(mean_component(e.coat), mean_component(e.specular), mean_component(e.diffuse));
    REAL sum = chance.x + chance.y + chance.z;
    return sum > R(0.0) ? chance / sum : VEC3(R(0.0), R(0.0), R(1.0));
}

FN VEC3 clearcoat_sample(BsdfParameters p, VEC3 wo, VEC3 u) {
    VEC3 chance = clearcoat_probabilities(p, wo.z);
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < chance.x) return ggx_sample_lobe(wo, v, p.coat_alpha, p.coat_alpha);
    if (u.z < chance.x + chance.y) return ggx_sample_lobe(wo, v, p.alpha_x, p.alpha_y);
    return cosine_sample(v);
}

FN REAL clearcoat_pdf(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC3 chance = clearcoat_probabilities(p, wo.z);
    return chance.x * ggx_pdf_lobe(wi, wo, p.coat_alpha, p.coat_alpha) +
           chance.y * ggx_pdf_lobe(wi, wo, p.alpha_x, p.alpha_y) +
           chance.z * wi.z * R(0.3183098861837907);
}
