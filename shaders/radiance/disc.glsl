// Mean of a GGX lobe over a disc of half vectors: a light that has a size, seen by a pixel whose
// normals vary. Needs microfacet.glsl.
//
// GGX slopes are distributed as p(s) = a^2 / (pi (|s|^2 + a^2)^2), which is the stereographic
// picture of a uniform sphere. A disc in the plane is a cap there, so the mean of p over a disc of
// radius r around s is exact: with b = |s|^2 + a^2 - r^2 and q = sqrt(b^2 + 4 a^2 r^2),
//   mean = (1 - b / q) / (2 pi r^2) = 2 a^2 / (pi q (q + b)),
// in units where a is the geometric mean of both slope parameters. The light's disc of half-angle
// rho has an elliptic picture among the half vectors' slopes; the disc of the same area stands for
// it: r^2 = rho^2 / (2 |H| c^3), H = wi + wo, c its cosine (over 60 degrees every lobe is smooth and
// the size of the light does not matter). Normals with mean squared slope m add r^2 = 2 m.

// Distribution times visibility as ggx_distribution_visibility; light_radius2 = rho^2.
FN REAL disc_distribution_visibility(VEC3 wi,
                                     VEC3 wo,
                                     REAL hh,
                                     VEC2 slopes,
                                     REAL light_radius2,
                                     REAL mean_squared_slope) {
    REAL hx = wi.x + wo.x;
    REAL hy = wi.y + wo.y;
    REAL hz = wi.z + wo.z;
    REAL a2 = slopes.x * slopes.y;
    REAL ratio = slopes.y / slopes.x;
    REAL hz2 = hz * hz;
    // b and q, times H.z^2
    REAL h = sqrt(hh);
    REAL c = max(hz / h, R(0.5));
    REAL r2 = hz2 * (MUTATED(disc_of_light, R(0.5) * light_radius2 / (h * c * c * c)) +
                     MUTATED(disc_of_slopes, R(2.0) * mean_squared_slope));
    REAL b = hx * hx * ratio + hy * hy / ratio + hz2 * a2 - r2;
    REAL cross_term = R(4.0) * r2 * a2 * hz2;
    REAL q = sqrt(b * b + cross_term);
    REAL sum = b > R(0.0) ? q + b : cross_term / (q - b);
    return MUTATED(disc_mean, a2 * hh * hh * R(0.3183098861837907)) /
           (q * sum * smith_denominator(wi, wo, slopes.x, slopes.y));
}
