// Gaussian slopes: what Ward's and Cook and Torrance's lobes share. H = wi + wo is not normalised,
// so that tan^2 comes from its components and nothing cancels at the peak.

// exp(-tan^2 (cos^2 phi / ax^2 + sin^2 phi / ay^2)) of H.
FN REAL gaussian_slopes(REAL hx, REAL hy, REAL hz, REAL alpha_x, REAL alpha_y) {
    REAL x = hx / (hz * alpha_x);
    REAL y = hy / (hz * alpha_y);
    return exp(-(x * x + y * y));
}

// A half vector with the density of Beckmann's D times its cosine, then the mirror direction. May
// lie below the horizon.
FN VEC3 beckmann_sample_lobe(VEC3 wo, VEC2 u, REAL alpha_x, REAL alpha_y) {
    REAL r = sqrt(-log(max(R(1.0) - u.y, R(1e-30))));
    REAL phi = R(6.283185307179586) * u.x;
    VEC3 h = normalize(VEC3(alpha_x * r * cos(phi), alpha_y * r * sin(phi), R(1.0)));
    return mirrored_about(wo, h);
}

// Density of beckmann_sample_lobe: D c / (4 wo.h), with wo.h = |H| / 2.
FN REAL beckmann_pdf_lobe(VEC3 wi, VEC3 wo, REAL alpha_x, REAL alpha_y) {
    REAL hx = wi.x + wo.x;
    REAL hy = wi.y + wo.y;
    REAL hz = max(wi.z + wo.z, R(1e-6));
    REAL hh = hx * hx + hy * hy + hz * hz;
    if (hh < R(1e-8)) return R(0.0);
    return gaussian_slopes(hx, hy, hz, alpha_x, alpha_y) * hh * R(0.15915494309189535) /
           (alpha_x * alpha_y * (hz * hz * hz));
}
