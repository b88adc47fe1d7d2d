// Car paint: a clear coat over two lobes of flakes over a pigment. Needs clearcoat.glsl,
// thin_film.glsl. Local coordinates: z normal, x tangent.
//
//   f = f_coat + T(mu_i) T(mu_o) A(mu_i, mu_o) (f_flakes + f_pigment)
//   f_flakes = f0 D V(alpha) + (1 - f0) flake_f0 D V(flake_alpha)
//
// Flakes lie nearly flat; how far they lean is no single GGX distribution, but close to two. What
// the first lobe's flakes cover the second's cannot, hence 1 - f0: together they never return more
// than everything. Under a coat of index 1.5 no flake is met at more than 42 degrees, where
// Fresnel's term has not begun to rise, so each lobe's is a constant colour. Coat and absorption are
// clearcoat.glsl's, and so is what the coat's inner reflections do to the pigment. The flakes lie
// the same along and across. A thin film on the second lobe's turns flake_f0 into a colour that
// depends on the half angle; the pigment then sees what the film lets through at least.

struct CarPaintPrepared {
    GgxPrepared base;    // the first lobe; the pigment is its diffuse layer
    AlbedoFit flake;      // of the second lobe
    FilmPrepared flakes;  // what its flakes reflect
    CoatPrepared coat;
    CoatEntry base_entry;
    CoatEntry flake_entry;
};

// What the flakes let through to the pigment of a light that each lobe loses that much of: 1 - E
// without cancellation. Where they lose it, it is the pigment's too.
FN VEC3 car_paint_passed(IN(CarPaintPrepared) q, REAL loss, REAL flake_loss) {
    VEC3 one = VEC3(R(1.0));
    return MUTATED(flakes_pass,
                   (one - q.base.f0) * (one - q.flakes.most * (R(1.0) - flake_loss)) +
                       q.base.f0 * loss);
}

FN CarPaintPrepared car_paint_prepare(IN(BsdfParameters) p) {
    BsdfParameters not_stretched = p;
    not_stretched.alpha_y = p.alpha_x;
    CarPaintPrepared q;
    q.base = ggx_interface(not_stretched);
    q.flake = albedo_fit(p.flake_alpha);
    q.base_entry = coat_entry(p.alpha_x);
    q.flake_entry = coat_entry(p.flake_alpha);
    q.flakes = film_prepare(p);
    q.coat = coat_prepare(p);
    VEC3 passed =
        car_paint_passed(q, ggx_average_loss(p.alpha_x), ggx_average_loss(p.flake_alpha));
    q.base =
        coated_base(q.base, q.coat, p.diffuse, max(passed, VEC3(R(0.001))), VEC3(R(0.0)));
    return q;
}

FN int lobe_count(IN(CarPaintPrepared) q) {
    return 3;
}

FN VEC2 slopes_of(IN(CarPaintPrepared) q, int lobe) {
    REAL alpha = lobe == COAT_LOBE    ? q.coat.alpha
                 : lobe == FLAKE_LOBE ? q.flake.alpha
                                      : q.base.alpha_x;
    return VEC2(alpha, alpha);
}

FN Passage passage_of(IN(CarPaintPrepared) q, REAL mu) {
    REAL loss;
    REAL flake_loss;
    REAL cosine;
    ggx_albedo_fit(mu, q.base.layer, loss, cosine);
    ggx_albedo_fit(mu, q.flake, flake_loss, cosine);
    return coated_passage(q.coat, car_paint_passed(q, loss, flake_loss), mu);
}

FN VEC3 reflected(IN(CarPaintPrepared) q, IN(Passage) from, IN(Passage) to, REAL hh, VEC3 lobes) {
    VEC3 flakes = (VEC3(R(1.0)) - q.base.f0) * film_reflectance(q.flakes, hh);
    VEC3 pigment = q.base.diffuse * from.base * to.base * R(0.3183098861837907);
    VEC3 under = q.base.f0 * lobes.x + MUTATED(flake_lobe, flakes * lobes.z) +
                 MUTATED(pigment, pigment);
    return reflected_through(q.coat, from, to, under, hh, lobes.y);
}

FN VEC3 evaluate(IN(CarPaintPrepared) q, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    VEC3 lobes =
        VEC3(ggx_distribution_visibility(wi, wo, hh, q.base.alpha_x, q.base.alpha_x),
             ggx_distribution_visibility(wi, wo, hh, q.coat.alpha, q.coat.alpha),
             ggx_distribution_visibility(wi, wo, hh, q.flake.alpha, q.flake.alpha));
    return reflected(q, passage_of(q, wi.z), passage_of(q, wo.z), hh, lobes);
}

FN VEC3 car_paint_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return evaluate(car_paint_prepare(p), wi, wo);
}

FN VEC3 sky_weight(IN(CarPaintPrepared) q, IN(Passage) to) {
    return coated_sky_weight(q.base, q.coat, to);
}

// |wi + wo|^2 of the light that a lobe mostly sends to mu: it enters from higher than the mirror
// direction, the more so the wider the lobe is.
FN REAL car_paint_mirror_hh(REAL mu, REAL alpha) {
    REAL a2 = alpha * alpha;
    REAL mu_in = sqrt((mu * mu + a2) / (R(1.0) + a2));
    REAL sines = sqrt((R(1.0) - mu * mu) * (R(1.0) - mu_in * mu_in));
    return R(2.0) * (R(1.0) + mu * mu_in - sines);
}

// What a lobe of flakes of reflectance 1 mirrors, the coat passed both ways.
FN VEC3 car_paint_lobe(
    IN(CoatPrepared) c, IN(CoatEntry) e, IN(AlbedoFit) fit, IN(Passage) to, REAL mu, IN(MirrorGrazing) grazing) {
    REAL loss;
    REAL cosine;
    ggx_albedo_fit(mu, fit, loss, cosine);
    return coated_entry(c, e, to, mu, grazing) * (R(1.0) - loss);
}

// Of the second lobe, whose flakes reflect that much.
FN VEC3 car_paint_flakes(
    IN(CarPaintPrepared) q, IN(Passage) to, REAL mu, IN(MirrorGrazing) grazing, VEC3 reflectance) {
    return MUTATED(flake_mirror_weight, (VEC3(R(1.0)) - q.base.f0) * reflectance) *
           car_paint_lobe(q.coat, q.flake_entry, q.flake, to, mu, grazing);
}

FN VEC3 mirror_weight(IN(CarPaintPrepared) q, IN(Passage) to, REAL mu, IN(MirrorGrazing) grazing, int lobe) {
    if (lobe == COAT_LOBE) return coat_weight(q.coat, mu, grazing);
    if (lobe == FLAKE_LOBE) {
        REAL hh = car_paint_mirror_hh(mu, q.flake.alpha);
        return car_paint_flakes(q, to, mu, grazing, film_reflectance(q.flakes, hh));
    }
    return q.base.f0 * car_paint_lobe(q.coat, q.base_entry, q.base.layer, to, mu, grazing);
}

FN BsdfEnvironment car_paint_environment(IN(BsdfParameters) p, REAL mu) {
    CarPaintPrepared q = car_paint_prepare(p);
    Passage to = passage_of(q, mu);
    BsdfEnvironment e;
    e.coat = mirror_weight(q, to, mu, even_light(), COAT_LOBE);
    e.specular = mirror_weight(q, to, mu, even_light(), BASE_LOBE) +
                 mirror_weight(q, to, mu, even_light(), FLAKE_LOBE);
    e.diffuse = sky_weight(q, to);
    return e;
}

// Chances of the coat, the first lobe and the second when a direction is sampled, and the pigment's:
// one minus the others would lose its digits. A film may reflect nothing under one angle and much
// under another: its most counts.
FN VEC3 car_paint_chances(IN(CarPaintPrepared) q, REAL mu, OUT(REAL) pigment) {
    Passage to = passage_of(q, mu);
    MirrorGrazing even = even_light();
    VEC3 most = q.flakes.most;
    REAL coat = mean_component(mirror_weight(q, to, mu, even, COAT_LOBE));
    REAL flakes = mean_component(mirror_weight(q, to, mu, even, BASE_LOBE) +
                                 car_paint_flakes(q, to, mu, even, most));
    REAL diffuse = mean_component(sky_weight(q, to));
    REAL sum = coat + flakes + diffuse;
    pigment = sum > R(0.0) ? diffuse / sum : R(1.0);
    if (sum <= R(0.0)) return VEC3(R(0.0));
    VEC2 lobes = lobe_chances(q.base.f0, (VEC3(R(1.0)) - q.base.f0) * most);
    return VEC3(coat, flakes * lobes.x, flakes * lobes.y) / sum;
}

FN VEC3 sampled(IN(CarPaintPrepared) q, VEC3 wo, VEC3 u) {
    REAL pigment;
    VEC3 chance = car_paint_chances(q, wo.z, pigment);
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < chance.x) return ggx_sample_lobe(wo, v, q.coat.alpha, q.coat.alpha);
    if (u.z < chance.x + chance.y) return ggx_sample_lobe(wo, v, q.base.alpha_x, q.base.alpha_x);
    if (u.z < chance.x + chance.y + chance.z) {
        return ggx_sample_lobe(wo, v, q.flake.alpha, q.flake.alpha);
    }
    return cosine_sample(v);
}

FN VEC3 car_paint_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    return sampled(car_paint_prepare(p), wo, u);
}

FN REAL density(IN(CarPaintPrepared) q, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    REAL pigment;
    VEC3 chance = car_paint_chances(q, wo.z, pigment);
    return chance.x * ggx_pdf_lobe(wi, wo, q.coat.alpha, q.coat.alpha) +
           chance.y * ggx_pdf_lobe(wi, wo, q.base.alpha_x, q.base.alpha_x) +
           chance.z * ggx_pdf_lobe(wi, wo, q.flake.alpha, q.flake.alpha) +
           pigment * wi.z * R(0.3183098861837907);
}

FN REAL car_paint_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    return density(car_paint_prepare(p), wi, wo);
}
