// GGX microfacets with height-correlated Smith masking, in forms that stay finite.
// Walter et al. (2007), Heitz (2014), Heitz (2018), Dupuy and Benyoub (2023).

// Height-correlated Smith masking and shadowing: G / (4 mu_i mu_o) is one over twice this.
FN REAL smith_denominator(VEC3 wi, VEC3 wo, REAL alpha_x, REAL alpha_y) {
    REAL mu_i = max(wi.z, R(1e-6));
    REAL mu_o = max(wo.z, R(1e-6));
    REAL xi = alpha_x * wi.x;
    REAL yi = alpha_y * wi.y;
    REAL xo = alpha_x * wo.x;
    REAL yo = alpha_y * wo.y;
    REAL length_i = sqrt(xi * xi + yi * yi + mu_i * mu_i);
    REAL length_o = sqrt(xo * xo + yo * yo + mu_o * mu_o);
    return MUTATED(smith_masking, mu_i * length_o + mu_o * length_i);
}

// Distribution times visibility, D G / (4 mu_i mu_o). H is not normalised: with s2 = |N x H|^2
// taken from its tangential components there is no 1 - cos^2, and nothing cancels at the peak.
// hh = |H|^2.
FN REAL ggx_distribution_visibility(VEC3 wi, VEC3 wo, REAL hh, REAL alpha_x, REAL alpha_y) {
    REAL hx = wi.x + wo.x;
    REAL hy = wi.y + wo.y;
    REAL hz = wi.z + wo.z;
    REAL a2 = alpha_x * alpha_y;
    REAL ratio = alpha_y / alpha_x;
    REAL k = hh / (hx * hx * ratio + hy * hy / ratio + hz * hz * a2);
    return MUTATED(ggx_distribution, a2 * k * k * R(0.15915494309189535)) /
           smith_denominator(wi, wo, alpha_x, alpha_y);
}

// A visible normal (spherical caps), then the mirror direction. May lie below the horizon.
FN VEC3 ggx_sample_lobe(VEC3 wo, VEC2 u, REAL alpha_x, REAL alpha_y) {
    VEC3 w = normalize(VEC3(alpha_x * wo.x, alpha_y * wo.y, wo.z));
    REAL phi = R(6.283185307179586) * u.x;
    REAL z = (R(1.0) - u.y) * (R(1.0) + w.z) - w.z;
    REAL s = sqrt(max((R(1.0) - z) * (R(1.0) + z), R(0.0)));
    VEC3 h = normalize(VEC3(alpha_x * (s * cos(phi) + w.x),
                            alpha_y * (s * sin(phi) + w.y),
                            max(z + w.z, R(0.0))));
    return h * (R(2.0) * dot(wo, h)) - wo;
}

// Density of ggx_sample_lobe over solid angle: G1(wo) D / (4 mu_o).
FN REAL ggx_pdf_lobe(VEC3 wi, VEC3 wo, REAL alpha_x, REAL alpha_y) {
    REAL hx = wi.x + wo.x;
    REAL hy = wi.y + wo.y;
    REAL hz = wi.z + wo.z;
    REAL hh = hx * hx + hy * hy + hz * hz;
    if (hh < R(1e-8)) return R(0.0);
    REAL a2 = alpha_x * alpha_y;
    REAL ratio = alpha_y / alpha_x;
    REAL k = hh / (hx * hx * ratio + hy * hy / ratio + hz * hz * a2);
    REAL mu_o = max(wo.z, R(1e-6));
    REAL xo = alpha_x * wo.x;
    REAL yo = alpha_y * wo.y;
    REAL length_o = sqrt(xo * xo + yo * yo + mu_o * mu_o);
    return MUTATED(ggx_density, a2 * k * k * R(0.15915494309189535) / (mu_o + length_o));
}

// (1 - cos)^5 between a direction and the half vector: |H| = 2 cos.
FN REAL schlick_weight(REAL hh) {
    REAL m = max(R(1.0) - R(0.5) * sqrt(hh), R(0.0));
    REAL m2 = m * m;
    return MUTATED(schlick, m2 * m2 * m);
}

// Reflectance at grazing incidence: 1 for every real interface, fading out below f0 = 0.02 so that
// f0 = 0 means no interface at all (Lagarde and de Rousiers 2014).
FN REAL grazing_reflectance(REAL f0_max) {
    return min(R(50.0) * f0_max, R(1.0));
}

FN REAL max_component(VEC3 v) {
    return max(v.x, max(v.y, v.z));
}

// Fresnel's equations. The reflectance of an interface goes from f0 along the normal to f90 at
// grazing incidence, F = f90 - (f90 - f0) rest: `rest` is what is left of the way, 1 to 0. For a
// dielectric and unpolarised light it is T / (1 - f0), T being what passes,
//   T = 2 g c (1 / (g + c)^2 + n^2 / (n^2 c + g)^2), g^2 = n^2 - 1 + c^2,
// in which nothing cancels at grazing incidence, nor where n is near 1:
// n^2 - 1 = 4 r / (1 - r)^2 with r^2 = f0.
struct Fresnel {
    REAL beyond;  // n^2 - 1
    REAL rest;    // 1 - f0 of the dielectric
    REAL metal;   // 0 for dielectrics, 1 for metals
};

FN REAL dielectric_rest(IN(Fresnel) q, REAL c) {
    REAL n2 = R(1.0) + q.beyond;
    REAL g = sqrt(q.beyond + c * c);
    REAL across = g + c;
    REAL along = n2 * c + g;
    REAL both = across * along;
    return MUTATED(fresnel_dielectric,
                   R(2.0) * g * c * (along * along + n2 * across * across) /
                       max(both * both * q.rest, R(1e-30)));
}

// 0 for dielectrics, f0 up to 0.2 (index 2.6), and 1 for metals, from 0.4 on; hardly a paint is
// between, where the way of f0 = 0.2 goes over into theirs.
FN REAL metal_share(REAL f0) {
    REAL m = clamp(R(5.0) * f0 - R(1.0), R(0.0), R(1.0));
    return m * m * (R(3.0) - R(2.0) * m);
}

// f0 is the largest channel's; below 0.02, where f90 fades out, the way is that of 0.02.
FN Fresnel fresnel_prepare(REAL f0) {
    REAL dielectric = clamp(f0, R(0.02), R(0.2));
    REAL r = sqrt(dielectric);
    REAL left = R(1.0) - r;
    Fresnel q;
    q.beyond = R(4.0) * r / (left * left);
    q.rest = R(1.0) - dielectric;
    q.metal = metal_share(f0);
    return q;
}

// Metals keep Schlick's 1 - (1 - c)^5, which is near theirs. Rounding may not lengthen the way: a
// channel of f0 = 0 would reflect less than nothing.
FN REAL fresnel_rest(IN(Fresnel) q, REAL c) {
    REAL schlick = c * (R(5.0) - c * (R(10.0) - c * (R(10.0) - c * (R(5.0) - c))));
    REAL exact = dielectric_rest(q, c);
    return min(exact + (schlick - exact) * q.metal, R(1.0));
}

// How much of the way F has gone between a direction and the half vector: |H| = 2 cos.
FN REAL fresnel_weight(IN(Fresnel) q, REAL hh) {
    return R(1.0) - fresnel_rest(q, min(R(0.5) * sqrt(hh), R(1.0)));
}

// The same averaged over the hemisphere with the cosine; of dielectrics at most 0.001 too small.
FN REAL dielectric_average_weight(REAL f0) {
    REAL r = sqrt(clamp(f0, R(0.02), R(0.2)));
    return r * (R(0.55538) -
                r * (R(2.09174) - r * (R(4.26046) - r * (R(5.31541) - r * R(2.55192)))));
}

FN REAL fresnel_average_weight(REAL f0) {
    REAL exact = dielectric_average_weight(f0);
    return MUTATED(fresnel_average,
                   exact + (R(0.047619047619047616) - exact) * metal_share(f0));
}

// Directional albedo of the lobe, E = (1 - loss) F(cosine): `loss` is what masking takes at f0 = 1,
// and an effective cosine stands for all facets. Rational fits of our own quadrature, alpha in
// [1e-4, 1] and f0 in [0.02, 1]: 1 - loss is at most 0.0066 too large, and E at most 0.009 more, 0.041
// within 4 degrees of grazing; together they are nowhere more than 1e-4 too small, so that what is
// left for the layers below is never too much.
struct AlbedoFit {
    REAL alpha;
    VEC3 loss_above;  // coefficients of the numerator and of the denominator
    VEC3 loss_below;
    REAL cosine_above0;
    REAL cosine_above1;
    REAL cosine_below0;
    REAL cosine_below1;
};

FN AlbedoFit albedo_fit(REAL alpha) {
    REAL a = alpha;
    AlbedoFit fit;
    fit.alpha = a;
    fit.loss_above = VEC3(R(0.00006) - a * (R(0.01023) - a * (R(0.78648) - a * R(0.54912))),
                          -R(0.13743) - a * (R(0.60375) - a * R(0.96872)),
                          R(1.91749) + a * R(0.70715));
    fit.loss_below = VEC3(R(0.57679) - a * (R(0.80506) - a * (R(0.80967) - a * R(0.28165))),
                          R(2.87614) - a * (R(0.62389) - a * R(0.21578)),
                          a * R(0.49333) - R(6.24262));
    fit.cosine_above0 = a * (R(2.47435) + a * (R(2.9317) - a * R(1.28922)));
    fit.cosine_above1 = a * (-R(3.84045) - a * R(6.87772));
    fit.cosine_below0 = R(1.08311) + a * (R(6.9501) + a * R(1.08186));
    fit.cosine_below1 = -R(0.93321) - a * R(8.6096);
    return fit;
}

FN void ggx_albedo_fit(REAL mu, IN(AlbedoFit) fit, OUT(REAL) loss, OUT(REAL) cosine) {
    REAL a = fit.alpha;
    REAL m = max(mu, R(1e-6));
    REAL inverse = R(1.0) / (m + a);
    REAL t = m * inverse;
    REAL v = a * inverse;
    // The numerator in powers of 1 - t: in powers of t its terms nearly cancel for small alpha.
    VEC3 n = fit.loss_above;
    VEC3 d = fit.loss_below;
    REAL lost = t * (n.x + v * (n.y + v * (n.z - v * R(1.78348)))) /
                (d.x + t * (d.y + t * (d.z + t * R(3.7214))));
    REAL c = m + (fit.cosine_above0 + t * (fit.cosine_above1 + t * (a * R(1.3444)))) /
                     (fit.cosine_below0 + t * (fit.cosine_below1 + t * R(0.19318)));
    loss = MUTATED(albedo_loss, max(lost, R(0.0)));
    cosine = MUTATED(albedo_cosine, clamp(c, R(0.0), R(1.0)));
}

// E = f0 (white - grazing) + f90 grazing.
FN void ggx_albedo(
    REAL mu, IN(AlbedoFit) fit, IN(Fresnel) fresnel, OUT(REAL) white, OUT(REAL) grazing) {
    REAL loss;
    REAL cosine;
    ggx_albedo_fit(mu, fit, loss, cosine);
    white = R(1.0) - loss;
    grazing = white * (R(1.0) - fresnel_rest(fresnel, cosine));
}

// 1 - E = (1 - f90) + loss_part + (f90 - f0) rest, without the cancellation near grazing:
// loss_part = f90 loss, rest = (1 - loss) fresnel_rest.
FN void ggx_transmission_fit(
    REAL mu, IN(AlbedoFit) fit, IN(Fresnel) fresnel, OUT(REAL) loss, OUT(REAL) rest) {
    REAL c;
    ggx_albedo_fit(mu, fit, loss, c);
    rest = (R(1.0) - loss) * fresnel_rest(fresnel, c);
}

// 1 - white, averaged over the hemisphere with the cosine.
FN REAL ggx_average_loss(REAL alpha) {
    REAL a = alpha;
    return MUTATED(albedo_average_loss,
        R(0.000038) -
            a * (R(0.003956) -
                 a * (R(2.884075) - a * (R(5.08867) - a * (R(4.10955) - a * R(1.312381))))));
}

// The average of both; never above that of ggx_albedo, at most 0.0024 (white), 0.006 (grazing, of
// dielectrics; 0.003 for f0 = 0.04) and 0.0013 (of metals) below. A rough interface has less of the
// way to grazing: by one factor for all dielectrics.
FN void ggx_average_albedo(REAL alpha, REAL f0, OUT(REAL) white, OUT(REAL) grazing) {
    REAL a = alpha;
    white = R(1.0) - ggx_average_loss(a);
    REAL roughness_factor =
        R(1.00019) -
        a * (R(1.86899) +
             a * (R(2.38278) -
                  a * (R(15.39787) - a * (R(26.61787) - a * (R(20.95527) - a * R(6.35636))))));
    REAL metal =
        R(0.047629) -
        a * (R(0.094853) +
             a * (R(0.349535) -
                  a * (R(1.842984) - a * (R(3.26051) - a * (R(2.617805) - a * R(0.800612))))));
    REAL exact = dielectric_average_weight(f0) * roughness_factor;
    grazing = MUTATED(albedo_average_grazing, exact + (metal - exact) * metal_share(f0)) -
              R(0.0001);
}
