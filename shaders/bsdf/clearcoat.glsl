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

struct CoatPrepared {
    REAL alpha;
    REAL f0;
    REAL f90;                    // reflectance at grazing incidence
    Fresnel fresnel;
    AlbedoFit albedo;
    REAL inverse_index_squared;  // 1 / n^2
    VEC3 log_transmittance;      // base 2, once through at normal incidence
};

FN CoatPrepared coat_prepare(IN(BsdfParameters) p) {
    REAL r = sqrt(p.coat_f0);
    REAL inverse_index = (R(1.0) - r) / (R(1.0) + r);
    CoatPrepared c;
    c.alpha = p.coat_alpha;
    c.f0 = p.coat_f0;
    c.f90 = grazing_reflectance(p.coat_f0);
    c.fresnel = fresnel_prepare(p.coat_f0);
    c.albedo = albedo_fit(p.coat_alpha);
    c.inverse_index_squared = inverse_index * inverse_index;
    c.log_transmittance = log2(max(p.coat_transmittance, VEC3(R(1e-6))));
    return c;
}

// Of light of which so many times as much grazes as of even light.
FN REAL coat_albedo(IN(CoatPrepared) c, REAL mu, REAL grazing_ratio) {
    REAL white;
    REAL grazing;
    ggx_albedo(mu, c.albedo, c.fresnel, white, grazing);
    grazing = min(grazing * grazing_ratio, white);
    return c.f0 * (white - grazing) + c.f90 * grazing;
}

FN REAL coat_transmission(IN(CoatPrepared) c, REAL mu) {
    REAL loss;
    REAL rest;
    ggx_transmission_fit(mu, c.albedo, c.fresnel, loss, rest);
    return MUTATED(coat_transmission, (R(1.0) - c.f90) + c.f90 * loss + (c.f90 - c.f0) * rest);
}

FN REAL coat_average_transmission(IN(CoatPrepared) c) {
    REAL white;
    REAL grazing;
    ggx_average_albedo(c.alpha, c.f0, white, grazing);
    return R(1.0) - c.f0 * (white - grazing) - c.f90 * grazing;
}

// Length of the refracted path through a coat of thickness 1.
FN REAL coat_path(IN(CoatPrepared) c, REAL mu) {
    // 1 less the squared sine in two parts, for which a coat of index 1 leaves the digits of mu
    REAL cos2 = (R(1.0) - c.inverse_index_squared) + mu * mu * c.inverse_index_squared;
    return MUTATED(coat_path, R(1.0) / sqrt(max(cos2, R(1e-4))));
}

FN VEC3 coat_absorption(IN(CoatPrepared) c, REAL path) {
    return exp2(MUTATED(coat_absorption, c.log_transmittance * path));
}

// Light from all around that a GGX lobe under the coat sends to mu enters under many cosines. One
// stands for them all, by what the coat transmits of it on the mean, and another by the path: where
// much arrives at grazing angles the mean direction would pass up to 5% too much. Squared, both are
// smooth in mu; fits of our own quadrature of even light (index 1.5, alpha .01 to 1), of its
// transmission within .4% and of its path within .3%, twice as much for mu < .15.
struct CoatEntry {
    REAL alpha;  // of the lobe
    REAL cosine0;
    VEC3 cosine;  // further coefficients
    VEC3 path;
};

FN CoatEntry coat_entry(REAL alpha) {
    REAL y = alpha / (alpha + R(0.3));
    CoatEntry e;
    e.alpha = alpha;
    e.cosine0 = y * (R(0.0045) + y * (R(1.3184) + y * (R(-1.3776) + y * R(-0.1443))));
    e.cosine = VEC3(y * (R(-0.2752) + y * (R(-6.9299) + y * (R(23.2973) + y * R(-16.975)))),
                    y * (R(1.9661) + y * (R(4.1632) + y * (R(-40.2442) + y * R(36.8058)))),
                    y * (R(-4.1456) + y * (R(4.8188) + y * (R(15.85) + y * R(-19.0556)))));
    e.path = VEC3(y * (R(0.1524) + y * (R(2.3192) + y * R(-2.5349))),
                  y * (R(-1.2958) + y * (R(2.3516) + y * R(-0.4029))),
                  y * (R(1.2878) + y * (R(-7.4003) + y * R(4.9449))));
    return e;
}

FN REAL coat_entry_cosine(IN(CoatEntry) e, REAL mu) {
    VEC3 c = e.cosine;
    REAL squared = mu * mu + e.cosine0 + mu * (c.x + mu * (c.y + mu * c.z));
    return sqrt(clamp(squared, R(0.0), R(1.0)));
}

// What the coat transmits of it where so many times as much grazes as of even light.
FN REAL coat_entry_transmission(IN(CoatPrepared) c, IN(CoatEntry) e, REAL mu, REAL grazing_ratio) {
    REAL even = coat_transmission(c, coat_entry_cosine(e, mu));
    REAL grazing = R(1.0) - c.f0 - even;
    return clamp(even + grazing * (R(1.0) - grazing_ratio), R(0.0), R(1.0));
}

FN REAL coat_entry_path(IN(CoatPrepared) c, IN(CoatEntry) e, REAL mu) {
    REAL squared = mu * mu + e.path.x + mu * (e.path.y + mu * e.path.z);
    return MUTATED(coat_entry_path, coat_path(c, sqrt(clamp(squared, R(0.0), R(1.0)))));
}

// The base with its diffuse layer of that albedo seen through the coat, where so much of the light
// inside of the coat passes the base on the mean. `grazing` is the share that the base keeps back of
// grazing light only.
FN GgxPrepared coated_base(
    IN(GgxPrepared) base, IN(CoatPrepared) c, VEC3 diffuse, VEC3 passed, VEC3 grazing) {
    REAL average = coat_average_transmission(c);
    VEC3 share = min(passed, VEC3(average));
    REAL inside = MUTATED(coat_inner_reflectance, R(1.0) - average * c.inverse_index_squared);
    GgxPrepared q = base;
    q.diffuse = diffuse * (R(1.0) - inside) / ((VEC3(R(1.0)) - diffuse * inside) * share);
    // Lit from everywhere it sees what passes both, which is a little more than the product of the
    // means: both keep back the same grazing light, with a covariance of 1/66 - 1/21^2 for Schlick's
    // weights. It is absorbed along the path of the mean cosine, 2/3.
    VEC3 both = passed * average + grazing * (R(0.0128838) * (c.f90 - c.f0));
    q.sky_diffuse =
        q.diffuse * both * coat_absorption(c, coat_path(c, R(0.6666666666666667)));
    return q;
}

struct ClearcoatPrepared {
    GgxPrepared base;  // its diffuse layer with the coat's inner reflections, and absorbed
    CoatPrepared coat;
    CoatEntry entry;
};

FN ClearcoatPrepared clearcoat_prepare(IN(BsdfParameters) p) {
    GgxPrepared base = ggx_interface(p);
    ClearcoatPrepared q;
    q.coat = coat_prepare(p);
    q.base = coated_base(base,
                         q.coat,
                         p.diffuse,
                         VEC3(R(1.0)) - ggx_interface_average(base),
                         VEC3(base.f90) - base.f0);
    q.entry = coat_entry(base.mirror.alpha);
    return q;
}

FN int lobe_count(IN(ClearcoatPrepared) q) {
    return 2;
}

FN VEC2 slopes_of(IN(ClearcoatPrepared) q, int lobe) {
    if (lobe == COAT_LOBE) return VEC2(q.coat.alpha, q.coat.alpha);
    return slopes_of(q.base, lobe);
}

FN Passage coated_passage(IN(CoatPrepared) c, VEC3 base, REAL mu) {
    Passage to;
    to.base = base;
    to.coat = coat_transmission(c, mu);
    to.path = coat_path(c, mu);
    return to;
}

FN Passage passage_of(IN(ClearcoatPrepared) q, REAL mu) {
    return coated_passage(q.coat, ggx_interface_transmission(q.base, mu), mu);
}

// hh = |wi + wo|^2
FN REAL coat_fresnel(IN(CoatPrepared) c, REAL hh) {
    return mix(c.f0, c.f90, fresnel_weight(c.fresnel, hh));
}

// A coat over what returns `under` of the light that passes it.
FN VEC3 reflected_through(
    IN(CoatPrepared) c, IN(Passage) from, IN(Passage) to, VEC3 under, REAL hh, REAL coat_lobe) {
    VEC3 passed = coat_absorption(c, from.path + to.path) * (from.coat * to.coat);
    return VEC3(MUTATED(coat_lobe, coat_fresnel(c, hh) * coat_lobe)) + passed * under;
}

FN VEC3 reflected(IN(ClearcoatPrepared) q, IN(Passage) from, IN(Passage) to, REAL hh, VEC3 lobes) {
    VEC3 under = reflected(q.base, from, to, hh, lobes);
    return reflected_through(q.coat, from, to, under, hh, lobes.y);
}

FN VEC3 evaluate(IN(ClearcoatPrepared) q, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    VEC3 lobes =
        VEC3(ggx_distribution_visibility(wi, wo, hh, q.base.alpha_x, q.base.alpha_y),
             ggx_distribution_visibility(wi, wo, hh, q.coat.alpha, q.coat.alpha),
             R(0.0));
    return reflected(q, passage_of(q, wi.z), passage_of(q, wo.z), hh, lobes);
}

FN VEC3 clearcoat_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return evaluate(clearcoat_prepare(p), wi, wo);
}

FN VEC3 coated_sky_weight(IN(GgxPrepared) base, IN(CoatPrepared) c, IN(Passage) to) {
    return base.sky_diffuse * to.base * coat_absorption(c, to.path) * to.coat;
}

FN VEC3 sky_weight(IN(ClearcoatPrepared) q, IN(Passage) to) {
    return coated_sky_weight(q.base, q.coat, to);
}

// Of the coat's own lobe.
FN VEC3 coat_weight(IN(CoatPrepared) c, REAL mu, IN(MirrorGrazing) grazing) {
    return VEC3(coat_albedo(c, mu, grazing_fresnel(grazing, c.alpha)));
}

// Through the coat both ways, of what a lobe under it mirrors.
FN VEC3 coated_entry(IN(CoatPrepared) c, IN(CoatEntry) e, IN(Passage) to, REAL mu, IN(MirrorGrazing) grazing) {
    REAL entered = coat_entry_transmission(c, e, mu, grazing_entry(grazing, e.alpha));
    return coat_absorption(c, to.path + coat_entry_path(c, e, mu)) * (to.coat * entered);
}

FN VEC3 mirror_weight(
    IN(ClearcoatPrepared) q, IN(Passage) to, REAL mu, IN(MirrorGrazing) grazing, int lobe) {
    if (lobe == COAT_LOBE) return coat_weight(q.coat, mu, grazing);
    return mirror_weight(q.base, to, mu, grazing, lobe) *
           coated_entry(q.coat, q.entry, to, mu, grazing);
}

FN BsdfEnvironment weights(IN(ClearcoatPrepared) q, REAL mu) {
    Passage to = passage_of(q, mu);
    BsdfEnvironment e;
    e.coat = mirror_weight(q, to, mu, even_light(), COAT_LOBE);
    e.specular = mirror_weight(q, to, mu, even_light(), BASE_LOBE);
    e.diffuse = sky_weight(q, to);
    return e;
}

FN BsdfEnvironment clearcoat_environment(IN(BsdfParameters) p, REAL mu) {
    return weights(clearcoat_prepare(p), mu);
}

// Chances of the coat, the base and the diffuse layer when a direction is sampled.
FN VEC3 clearcoat_chances(IN(ClearcoatPrepared) q, REAL mu) {
    BsdfEnvironment e = weights(q, mu);
    VEC3 chance =
        VEC3(mean_component(e.coat), mean_component(e.specular), mean_component(e.diffuse));
    REAL sum = chance.x + chance.y + chance.z;
    return sum > R(0.0) ? chance / sum : VEC3(R(0.0), R(0.0), R(1.0));
}

FN VEC3 sampled(IN(ClearcoatPrepared) q, VEC3 wo, VEC3 u) {
    VEC3 chance = clearcoat_chances(q, wo.z);
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < chance.x) return ggx_sample_lobe(wo, v, q.coat.alpha, q.coat.alpha);
    if (u.z < chance.x + chance.y) return ggx_sample_lobe(wo, v, q.base.alpha_x, q.base.alpha_y);
    return cosine_sample(v);
}

FN VEC3 clearcoat_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    return sampled(clearcoat_prepare(p), wo, u);
}

FN REAL density(IN(ClearcoatPrepared) q, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    VEC3 chance = clearcoat_chances(q, wo.z);
    return chance.x * ggx_pdf_lobe(wi, wo, q.coat.alpha, q.coat.alpha) +
           chance.y * ggx_pdf_lobe(wi, wo, q.base.alpha_x, q.base.alpha_y) +
           chance.z * wi.z * R(0.3183098861837907);
}

FN REAL clearcoat_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return density(clearcoat_prepare(p), wi, wo);
}
