// GGX interface over a diffuse layer. Needs microfacet.glsl, layers.glsl. Local coordinates: z the
// normal, x the tangent.
//
//   f = D F V + diffuse / pi (1 - E(mu_i)) (1 - E(mu_o)) / (1 - E_avg)
//
// E is the albedo of the interface, so what the interface reflects the diffuse layer does not
// (Kelemen and Szirmay-Kalos 2001): reciprocal, and a white layer returns everything. The interface
// itself scatters once: at f0 = 1 it loses 1 - E_white, 2% at normal incidence for alpha 0.13, 13%
// for 0.31, 69% for 1.

struct GgxPrepared {
    VEC3 f0;
    REAL f0_max;       // the largest channel: all go to grazing incidence as it does
    REAL f90;          // reflectance there
    Fresnel fresnel;
    REAL alpha_x;
    REAL alpha_y;
    AlbedoFit layer;   // of an interface that reflects at least as much in any azimuth
    AlbedoFit mirror;  // of a lobe that is as wide along as across
    VEC3 diffuse;      // of the layer, over the share of light that passes the interface
    VEC3 sky_diffuse;  // of the layer, for what passes of light from everywhere
};

FN int lobe_count(IN(GgxPrepared) q) {
    return 1;
}

FN VEC2 slopes_of(IN(GgxPrepared) q, int lobe) {
    return VEC2(q.alpha_x, q.alpha_y);
}

// Over a layer that sees all light.
FN GgxPrepared ggx_interface(IN(BsdfParameters) p) {
    REAL low = min(p.alpha_x, p.alpha_y);
    GgxPrepared q;
    q.f0 = p.f0;
    q.f0_max = max_component(p.f0);
    q.f90 = grazing_reflectance(q.f0_max);
    q.fresnel = fresnel_prepare(q.f0_max);
    q.alpha_x = p.alpha_x;
    q.alpha_y = p.alpha_y;
    q.layer = albedo_fit(low * sqrt(low / max(p.alpha_x, p.alpha_y)));
    q.mirror = albedo_fit(sqrt(p.alpha_x * p.alpha_y));
    q.diffuse = p.diffuse;
    q.sky_diffuse = p.diffuse;
    return q;
}

// What the interface lets through to the layer, at most; 1 - E.
FN VEC3 ggx_interface_transmission(IN(GgxPrepared) q, REAL mu) {
    REAL loss;
    REAL rest;
    ggx_transmission_fit(mu, q.layer, q.fresnel, loss, rest);
    return VEC3(R(1.0) - q.f90 + q.f90 * loss) + (VEC3(q.f90) - q.f0) * rest;
}

FN VEC3 ggx_interface_average(IN(GgxPrepared) q) {
    REAL white;
    REAL grazing;
    ggx_average_albedo(q.layer.alpha, q.f0_max, white, grazing);
    // The layer under a stretched lobe would return up to 1.4e-4 too much.
    REAL stretch = min(q.alpha_x, q.alpha_y) / max(q.alpha_x, q.alpha_y);
    REAL in_hand = R(1.0) - R(0.006) * (R(1.0) - stretch);
    return min(q.f0 * (white - grazing) + VEC3(q.f90 * grazing), VEC3(R(0.999))) * in_hand;
}

FN GgxPrepared ggx_prepare(IN(BsdfParameters) p) {
    GgxPrepared q = ggx_interface(p);
    q.diffuse =
        MUTATED(ggx_diffuse_layer, p.diffuse / (VEC3(R(1.0)) - ggx_interface_average(q)));
    return q;
}

// Over a medium whose light leaves beside where it entered: what the sky's layer holds is what
// leaves, and lamps see the interface alone.
FN GgxPrepared ggx_exit_prepare(IN(BsdfParameters) p) {
    GgxPrepared q = ggx_interface(p);
    // Of a body, whatever its index
    q.f90 = R(1.0);
    q.diffuse = VEC3(R(0.0));
    q.sky_diffuse = VEC3(R(1.0)) / (VEC3(R(1.0)) - ggx_interface_average(q));
    return q;
}

FN Passage passage_of(IN(GgxPrepared) q, REAL mu) {
    Passage to;
    to.base = ggx_interface_transmission(q, mu);
    to.coat = R(1.0);
    to.path = R(0.0);
    return to;
}

// hh = |wi + wo|^2
FN VEC3 ggx_fresnel(IN(GgxPrepared) q, REAL hh) {
    return mix(q.f0, VEC3(q.f90), fresnel_weight(q.fresnel, hh));
}

FN VEC3 reflected(IN(GgxPrepared) q, IN(Passage) from, IN(Passage) to, REAL hh, VEC3 lobes) {
    return ggx_fresnel(q, hh) * lobes.x +
           q.diffuse * from.base * to.base * R(0.3183098861837907);
}

FN VEC3 evaluate(IN(GgxPrepared) q, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL lobe = ggx_distribution_visibility(wi, wo, hh, q.alpha_x, q.alpha_y);
    return reflected(q, passage_of(q, wi.z), passage_of(q, wo.z), hh, VEC3(lobe));
}

FN VEC3 ggx_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return evaluate(ggx_prepare(p), wi, wo);
}

FN VEC3 sky_weight(IN(GgxPrepared) q, IN(Passage) to) {
    return MUTATED(ggx_sky_weight, q.sky_diffuse * to.base);
}

FN VEC3 mirror_weight(IN(GgxPrepared) q, IN(Passage) to, REAL mu, IN(MirrorGrazing) grazing_ratio, int lobe) {
    REAL white;
    REAL grazing;
    ggx_albedo(mu, q.mirror, q.fresnel, white, grazing);
    grazing = min(grazing * grazing_fresnel(grazing_ratio, q.mirror.alpha), white);
    return MUTATED(ggx_mirror_weight, q.f0 * (white - grazing) + VEC3(q.f90 * grazing));
}

FN BsdfEnvironment ggx_environment(IN(BsdfParameters) p, REAL mu) {
    GgxPrepared q = ggx_prepare(p);
    Passage to = passage_of(q, mu);
    BsdfEnvironment e;
    e.diffuse = sky_weight(q, to);
    e.specular = mirror_weight(q, to, mu, even_light(), BASE_LOBE);
    e.coat = VEC3(R(0.0));
    return e;
}

// Of sampling the microfacets and the diffuse layer.
FN VEC2 ggx_chances(IN(GgxPrepared) q, REAL mu) {
    VEC3 through = ggx_interface_transmission(q, mu);
    return lobe_chances(VEC3(R(1.0)) - through, q.sky_diffuse * through);
}

// u: three numbers in [0, 1). The direction may lie below the horizon, where evaluate() is 0.
FN VEC3 sampled(IN(GgxPrepared) q, VEC3 wo, VEC3 u) {
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < ggx_chances(q, wo.z).x) {
        return ggx_sample_lobe(wo, v, q.alpha_x, q.alpha_y);
    }
    return cosine_sample(v);
}

FN VEC3 ggx_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    return sampled(ggx_prepare(p), wo, u);
}

// Of sampled().
FN REAL density(IN(GgxPrepared) q, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC2 chance = ggx_chances(q, wo.z);
    return chance.x * ggx_pdf_lobe(wi, wo, q.alpha_x, q.alpha_y) +
           chance.y * wi.z * R(0.3183098861837907);
}

FN REAL ggx_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return density(ggx_prepare(p), wi, wo);
}
