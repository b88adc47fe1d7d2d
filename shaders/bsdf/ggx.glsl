// GGX interface over a diffuse layer. Local coordinates: z the normal, x the tangent.
//
//   f = D F V + diffuse / pi (1 - E(mu_i)) (1 - E(mu_o)) / (1 - E_avg)
//
// E is the albedo of the interface, so what the interface reflects the diffuse layer does not
// (Kelemen and Szirmay-Kalos 2001): reciprocal, and a white layer returns everything. The interface
// itself scatters once: at f0 = 1 it loses 1 - E_white, 2% at normal incidence for alpha 0.13, 13%
// for 0.31, 69% for 1.

// The isotropic slope parameter whose interface reflects at least as much as a stretched one in any
// azimuth.
FN REAL ggx_layer_alpha(BsdfParameters p) {
    REAL low = min(p.alpha_x, p.alpha_y);
    return low * sqrt(low / max(p.alpha_x, p.alpha_y));
}

// What the interface lets through to the layer, at most; 1 - E.
FN VEC3 ggx_interface_transmission(BsdfParameters p, REAL mu) {
    REAL loss;
    REAL rest;
    REAL f0_max = max_component(p.f0);
    ggx_transmission_fit(mu, ggx_layer_alpha(p), f0_max, loss, rest);
    REAL f90 = grazing_reflectance(f0_max);
    return VEC3(R(1.0) - f90 + f90 * loss) + (VEC3(f90) - p.f0) * rest;
}

FN VEC3 ggx_interface_albedo(BsdfParameters p, REAL mu) {
    return VEC3(R(1.0)) - ggx_interface_transmission(p, mu);
}

FN VEC3 ggx_interface_average(BsdfParameters p) {
    REAL white;
    REAL grazing;
    REAL f0_max = max_component(p.f0);
    ggx_average_albedo(ggx_layer_alpha(p), f0_max, white, grazing);
    REAL f90 = grazing_reflectance(f0_max);
    // The layer under a stretched lobe would return up to 1.4e-4 too much.
    REAL stretch = min(p.alpha_x, p.alpha_y) / max(p.alpha_x, p.alpha_y);
    REAL in_hand = R(1.0) - R(0.006) * (R(1.0) - stretch);
    return min(p.f0 * (white - grazing) + VEC3(f90 * grazing), VEC3(R(0.999))) * in_hand;
}

FN VEC3 ggx_specular(BsdfParameters p, VEC3 wi, VEC3 wo, REAL hh) {
    REAL f0_max = max_component(p.f0);
    REAL f90 = grazing_reflectance(f0_max);
    REAL weight = fresnel_weight(f0_max, hh);
    VEC3 fresnel = p.f0 * (R(1.0) - weight) + VEC3(f90 * weight);
    return fresnel * ggx_distribution_visibility(wi, wo, hh, p.alpha_x, p.alpha_y);
}

FN VEC3 ggx_eval(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    VEC3 through = ggx_interface_transmission(p, wi.z) * ggx_interface_transmission(p, wo.z) /
                   (VEC3(R(1.0)) - ggx_interface_average(p));
    return ggx_specular(p, wi, wo, hh) +
           p.diffuse * through * R(0.3183098861837907);
}

// Of sampling the microfacets and the diffuse layer.
FN VEC2 ggx_chances(BsdfParameters p, REAL mu) {
    VEC3 through = ggx_interface_transmission(p, mu);
    return lobe_chances(VEC3(R(1.0)) - through, p.diffuse * through);
}

// u: three numbers in [0, 1). The direction may lie below the horizon, where ggx_eval is 0.
FN VEC3 ggx_sample(BsdfParameters p, VEC3 wo, VEC3 u) {
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < ggx_chances(p, wo.z).x) {
        return ggx_sample_lobe(wo, v, p.alpha_x, p.alpha_y);
    }
    return cosine_sample(v);
}

FN REAL ggx_pdf(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC2 chance = ggx_chances(p, wo.z);
    return chance.x * ggx_pdf_lobe(wi, wo, p.alpha_x, p.alpha_y) +
           chance.y * wi.z * R(0.3183098861837907);
}

// Of light of which so many times as much grazes as of even light.
FN VEC3 ggx_environment_albedo(BsdfParameters p, REAL mu, REAL grazing_ratio) {
    REAL white;
    REAL grazing;
    REAL f0_max = max_component(p.f0);
    ggx_albedo(mu, sqrt(p.alpha_x * p.alpha_y), f0_max, white, grazing);
    grazing = min(grazing * grazing_ratio, white);
    REAL f90 = grazing_reflectance(f0_max);
    return p.f0 * (white - grazing) + VEC3(f90 * grazing);
}

FN BsdfEnvironment ggx_environment(BsdfParameters p, REAL mu) {
    BsdfEnvironment e;
    e.diffuse = p.diffuse * ggx_interface_transmission(p, mu);
    e.specular = ggx_environment_albedo(p, mu, R(1.0));
    e.coat = VEC3(R(0.0));
    return e;
}
