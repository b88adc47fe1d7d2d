// GGX microfacets with height-correlated Smith masking, in forms that stay finite.
// Walter et al. (2007), Heitz (2014), Heitz (2018), Dupuy and Benyoub (2023).

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
    REAL mu_i = max(wi.z, R(1e-6));
    REAL mu_o = max(wo.z, R(1e-6));
    REAL xi = alpha_x * wi.x;
    REAL yi = alpha_y * wi.y;
    REAL xo = alpha_x * wo.x;
    REAL yo = alpha_y * wo.y;
    REAL length_i = sqrt(xi * xi + yi * yi + mu_i * mu_i);
    REAL length_o = sqrt(xo * xo + yo * yo + mu_o * mu_o);
    return a2 * k * k * R(0.15915494309189535) / (mu_i * length_o + mu_o * length_i);
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

// Directional albedo of the lobe, split over Fresnel: E = f0 (white - grazing) + f90 grazing, with
// `white` the albedo at f0 = 1. Rational fits of our own quadrature, alpha in [1e-4, 1]: white is
// at most 0.0065 too large and grazing at most 0.015, neither more than 0.001 too small, so that
// what is left for the layers below is never too much.
FN void ggx_albedo(REAL mu, REAL alpha, OUT(REAL) white, OUT(REAL) grazing) {
    REAL a = alpha;
    REAL m = max(mu, R(1e-6));
    REAL t = m / (m + a);
    REAL wn0 = R(0.04276) + a * (R(0.11819) + a * (R(1.52507) - a * R(0.47104)));
    REAL wn1 = R(0.96832) - a * (R(0.75883) + a * R(1.11471));
    REAL wn2 = a * R(0.67945) - R(2.15532);
    REAL wd0 = R(0.53459) - a * (R(0.58237) - a * (R(0.5108) - a * R(0.1632)));
    REAL wd1 = R(1.65424) + a * (R(0.15168) - a * R(0.02875));
    REAL wd2 = -R(4.34982) - a * R(0.28252);
    REAL loss = t * (wn0 + t * (wn1 + t * (wn2 + t * R(1.14427)))) /
                (wd0 + t * (wd1 + t * (wd2 + t * R(2.86114))));
    REAL cn0 = R(1.18372) + a * (R(6.94931) - a * R(2.90532));
    REAL cn1 = -R(1.14089) - a * R(12.0);
    REAL cd0 = R(0.29228) + a * (R(7.9) + a * R(3.96415));
    REAL cd1 = -R(0.007) - a * R(8.37169);
    REAL cosine = m + a * (cn0 + t * (cn1 - t * R(0.04245))) / (cd0 + t * (cd1 + t * R(0.14628)));
    REAL s = R(1.0) - clamp(cosine, R(0.0), R(1.0));
    REAL s2 = s * s;
    white = R(1.0) - max(loss, R(0.0));
    grazing = white * (s2 * s2 * s);
}

// The same, averaged over the hemisphere with the cosine; never above the average of ggx_albedo.
FN void ggx_average_albedo(REAL alpha, OUT(REAL) white, OUT(REAL) grazing) {
    REAL a = alpha;
    white = R(0.999977) -
            a * (R(0.028737) +
                 a * (R(2.709365) - a * (R(4.717107) - a * (R(3.756351) - a * R(1.188063)))));
    grazing = R(0.047628) -
              a * (R(0.087982) +
                   a * (R(0.219405) - a * (R(0.88794) - a * (R(1.002421) - a * R(0.378856)))));
}
