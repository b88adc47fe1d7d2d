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

// Of the second lobe's flakes where they are met under that half angle.
FN VEC3 car_paint_flakes(BsdfParameters p, REAL hh) {
    if (p.film_nm <= R(0.0)) return p.flake_f0;
    return film_reflectance(p, hh);
}

// The most that they reflect.
FN VEC3 car_paint_most(BsdfParameters p) {
    if (p.film_nm <= R(0.0)) return p.flake_f0;
    return film_most(p);
}

// What the flakes let through to the pigment of a light that each lobe loses that much of: 1 - E
// without cancellation. Where they lose it, it is the pigment's too.
FN VEC3 car_paint_passed(BsdfParameters p, VEC3 most, REAL loss, REAL flake_loss) {
    VEC3 one = VEC3(R(1.0));
    return (one - p.f0) * (one - most * (R(1.0) - flake_loss)) + p.f0 * loss;
}

FN VEC3 car_paint_transmission(BsdfParameters p, VEC3 most, REAL mu) {
    REAL loss;
    REAL flake_loss;
    REAL cosine;
    ggx_albedo_fit(mu, p.alpha_x, loss, cosine);
    ggx_albedo_fit(mu, p.flake_alpha, flake_loss, cosine);
    return car_paint_passed(p, most, loss, flake_loss);
}

// The pigment's share of the light that passes coat and flakes.
FN VEC3 car_paint_share(BsdfParameters p) {
    VEC3 passed = car_paint_passed(
        p, car_paint_most(p), ggx_average_loss(p.alpha_x), ggx_average_loss(p.flake_alpha));
    return min(max(passed, VEC3(R(0.001))), VEC3(coat_average_transmission(p)));
}

// The pigment's albedo with the coat's inner reflections, over that share.
FN VEC3 car_paint_pigment(BsdfParameters p, REAL inverse_index_squared) {
    return coated_diffuse_over(p, inverse_index_squared, car_paint_share(p));
}

FN VEC3 car_paint_eval(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    VEC3 h = wi + wo;
    REAL hh = dot(h, h);
    if (hh < R(1e-8)) return VEC3(R(0.0));
    REAL coat = coat_lobe(p, wi, wo, hh);
    REAL eta = coat_inverse_index_squared(p);
    VEC3 passed = coat_passed(p, wi.z, wo.z, eta);
    VEC3 flakes = p.f0 * ggx_distribution_visibility(wi, wo, hh, p.alpha_x, p.alpha_x) +
                  (VEC3(R(1.0)) - p.f0) * car_paint_flakes(p, hh) *
                      ggx_distribution_visibility(wi, wo, hh, p.flake_alpha, p.flake_alpha);
    VEC3 most = car_paint_most(p);
    VEC3 pigment = car_paint_pigment(p, eta) * car_paint_transmission(p, most, wi.z) *
                   car_paint_transmission(p, most, wo.z) * R(0.3183098861837907);
    return VEC3(coat) + passed * (flakes + pigment);
}

// |wi + wo|^2 of the light that a lobe mostly sends to mu: it enters from higher than the mirror
// direction, the more so the wider the lobe is.
FN REAL car_paint_mirror_hh(REAL mu, REAL alpha) {
    REAL a2 = alpha * alpha;
    REAL mu_in = sqrt((mu * mu + a2) / (R(1.0) + a2));
    REAL sines = sqrt((R(1.0) - mu * mu) * (R(1.0) - mu_in * mu_in));
    return R(2.0) * (R(1.0) + mu * mu_in - sines);
}

// Of light from all around through one lobe of flakes of reflectance 1, the coat passed both ways.
FN VEC3 car_paint_lobe(BsdfParameters p, REAL mu, REAL alpha, REAL eta) {
    REAL loss;
    REAL cosine;
    ggx_albedo_fit(mu, alpha, loss, cosine);
    REAL passed = coat_transmission(p, mu) * coat_transmission(p, coat_entry_cosine(mu, alpha));
    return coat_absorption(p, coat_path(mu, eta) + coat_entry_path(mu, alpha, eta)) *
           ((R(1.0) - loss) * passed);
}

// Where the flakes reflect that much.
FN BsdfEnvironment car_paint_parts(BsdfParameters p, VEC3 flakes, REAL mu) {
    REAL eta = coat_inverse_index_squared(p);
    BsdfEnvironment e;
    e.coat = VEC3(coat_albedo(p, mu, R(1.0)));
    e.specular = p.f0 * car_paint_lobe(p, mu, p.alpha_x, eta) +
                 (VEC3(R(1.0)) - p.f0) * flakes * car_paint_lobe(p, mu, p.flake_alpha, eta);
    // The pigment is lit from everywhere: absorbed along the path of the mean cosine, 2/3.
    REAL path = coat_path(mu, eta) + coat_path(R(0.6666666666666667), eta);
    e.diffuse = car_paint_pigment(p, eta) * car_paint_share(p) *
                car_paint_transmission(p, car_paint_most(p), mu) * coat_absorption(p, path) *
                coat_transmission(p, mu);
    return e;
}

FN BsdfEnvironment car_paint_environment(BsdfParameters p, REAL mu) {
    VEC3 flakes = car_paint_flakes(p, car_paint_mirror_hh(mu, p.flake_alpha));
    return car_paint_parts(p, flakes, mu);
}

// Chances of the coat, the first lobe and the second when a direction is sampled, and the pigment's:
// one minus the others would lose its digits. A film may reflect nothing under one angle and much
// under another: its most counts.
FN VEC3 car_paint_chances(BsdfParameters p, REAL mu, OUT(REAL) pigment) {
    VEC3 most = car_paint_most(p);
    BsdfEnvironment e = car_paint_parts(p, most, mu);
    REAL coat = mean_component(e.coat);
    REAL flakes = mean_component(e.specular);
    REAL diffuse = mean_component(e.diffuse);
    REAL sum = coat + flakes + diffuse;
    pigment = sum > R(0.0) ? diffuse / sum : R(1.0);
    if (sum <= R(0.0)) return VEC3(R(0.0));
    VEC2 lobes = lobe_chances(p.f0, (VEC3(R(1.0)) - p.f0) * most);
    return VEC3(coat, flakes * lobes.x, flakes * lobes.y) / sum;
}

FN VEC3 car_paint_sample(BsdfParameters p, VEC3 wo, VEC3 u) {
    REAL pigment;
    VEC3 chance = car_paint_chances(p, wo.z, pigment);
    VEC2 v = VEC2(u.x, u.y);
    if (u.z < chance.x) return ggx_sample_lobe(wo, v, p.coat_alpha, p.coat_alpha);
    if (u.z < chance.x + chance.y) return ggx_sample_lobe(wo, v, p.alpha_x, p.alpha_x);
    if (u.z < chance.x + chance.y + chance.z) {
        return ggx_sample_lobe(wo, v, p.flake_alpha, p.flake_alpha);
    }
    return cosine_sample(v);
}

FN REAL car_paint_pdf(BsdfParameters p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    REAL pigment;
    VEC3 chance = car_paint_chances(p, wo.z, pigment);
    return chance.x * ggx_pdf_lobe(wi, wo, p.coat_alpha, p.coat_alpha) +
           chance.y * ggx_pdf_lobe(wi, wo, p.alpha_x, p.alpha_x) +
           chance.z * ggx_pdf_lobe(wi, wo, p.flake_alpha, p.flake_alpha) +
           pigment * wi.z * R(0.3183098861837907);
}
