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
    return mu_i * length_o + mu_o * length_i;
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
    return a2 * k * k * R(0.15915494309189535) / smith_denominator(wi, wo, alpha_x, alpha_y);
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
    return a2 * k * k * R(0.15915494309189535) / (mu_o + length_o);
}

// (1 - cos)^5 between a direction and the half vector: |H| = 2 cos.
FN REAL schlick_weight(REAL hh) {
    REAL m = max(R(1.0) - R(0.5) * sqrt(hh), R(0.0));
    REAL m2 = m * m;
    return m2 * m2 * m;
}

// Reflectance at grazing incidence: 1 for every real interface, fading out below f0 = 0.02 so that
// f0 = 0 means no interface at all (Lagarde and de Rousiers 2014).
FN REAL grazing_reflectance(REAL f0_max) {
    return min(R(50.0) * f0_max, R(1.0));
}

FN REAL max_component(VEC3 v) {
    return max(v.x, max(v.y, v.z));
}

// Directional albedo of the lobe, E = (1 - loss) (f0 (1 - edge) + f90 edge): `loss` is what
// masking takes at f0 = 1, edge = (1 - cosine)^5 Schlick's weight at an effective cosine. Rational
// fits of our own quadrature, alpha in [1e-4, 1]: 1 - loss is at most 0.0066 too large and
// (1 - loss) edge at most 0.017, neither more than 1e-4 too small, so that what is left for the
// layers below is never too much.
FN void ggx_albedo_fit(REAL mu, REAL alpha, OUT(REAL) loss, OUT(REAL) cosine) {
    REAL a = alpha;
    REAL m = max(mu, R(1e-6));
    REAL t = m / (m + a);
    REAL v = a / (m + a);
    // The numerator in powers of 1 - t: in powers of t its terms nearly cancel for small alpha.
    REAL wn0 = R(0.00006) - a * (R(0.01023) - a * (R(0.78648) - a * R(0.54912)));
    REAL wn1 = -R(0.13743) - a * (R(0.60375) - a * R(0.96872));
    REAL wn2 = R(1.91749) + a * R(0.70715);
    REAL wd0 = R(0.57679) - a * (R(0.80506) - a * (R(0.80967) - a * R(0.28165)));
    REAL wd1 = R(2.87614) - a * (R(0.62389) - a * R(0.21578));
    REAL wd2 = a * R(0.49333) - R(6.24262);
    REAL lost = t * (wn0 + v * (wn1 + v * (wn2 - v * R(1.78348)))) /
                (wd0 + t * (wd1 + t * (wd2 + t * R(3.7214))));
    REAL cn0 = R(1.23986) + a * (R(7.23334) - a * R(3.24966));
    REAL cn1 = -R(1.41008) - a * R(12.0);
    REAL cd0 = R(0.31469) + a * (R(8.29508) + a * R(3.67251));
    REAL cd1 = -R(0.15546) - a * R(8.71006);
    REAL c = m + a * (cn0 + t * (cn1 + t * R(0.16083))) / (cd0 + t * (cd1 + t * R(0.29286)));
    loss = max(lost, R(0.0));
    cosine = clamp(c, R(0.0), R(1.0));
}

// E = f0 (white - grazing) + f90 grazing.
FN void ggx_albedo(REAL mu, REAL alpha, OUT(REAL) white, OUT(REAL) grazing) {
    REAL loss;
    REAL cosine;
    ggx_albedo_fit(mu, alpha, loss, cosine);
    REAL s = R(1.0) - cosine;
    REAL s2 = s * s;
    white = R(1.0) - loss;
    grazing = white * (s2 * s2 * s);
}

// 1 - E = (1 - f90) + loss_part + (f90 - f0) rest, without the cancellation near grazing:
// loss_part = f90 loss, rest = (1 - loss) (1 - edge).
FN void ggx_transmission_fit(REAL mu, REAL alpha, OUT(REAL) loss, OUT(REAL) rest) {
    REAL c;
    ggx_albedo_fit(mu, alpha, loss, c);
    REAL not_edge = c * (R(5.0) - c * (R(10.0) - c * (R(10.0) - c * (R(5.0) - c))));
    rest = (R(1.0) - loss) * not_edge;
}

// 1 - white, averaged over the hemisphere with the cosine.
FN REAL ggx_average_loss(REAL alpha) {
    REAL a = alpha;
    return R(0.000038) -
           a * (R(0.003956) -
                a * (R(2.884075) - a * (R(5.08867) - a * (R(4.10955) - a * R(1.312381)))));
}

// The average of both; never above that of ggx_albedo, at most 0.0024 (white) and 0.001 (grazing)
// below.
FN void ggx_average_albedo(REAL alpha, OUT(REAL) white, OUT(REAL) grazing) {
    REAL a = alpha;
    white = R(1.0) - ggx_average_loss(a);
    grazing = R(0.047628) -
              a * (R(0.083194) +
                   a * (R(0.28277) - a * (R(1.07906) - a * (R(1.220033) - a * R(0.464282)))));
}
