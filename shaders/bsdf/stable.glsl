// Functions whose plain forms lose digits or divide 0 by 0, and that GLSL does not have.

// log(1 - s2) / s2 for a squared sine s2 and its squared cosine c2: -1 at s2 = 0. Small sines by the
// series of the inverse hyperbolic tangent, which no rounding of 1 - s2 spoils.
FN REAL log_cosine_ratio(REAL s2, REAL c2) {
    if (s2 > R(0.25)) return log(max(c2, R(1e-30))) / s2;
    REAL y = s2 / (R(2.0) - s2);
    REAL q = y * y;
    REAL sum = R(1.0) + q * (R(0.3333333333333333) +
               q * (R(0.2) + q * (R(0.14285714285714285) + q * (R(0.1111111111111111) +
               q * (R(0.09090909090909091) + q * (R(0.07692307692307693) +
               q * (R(0.06666666666666667) + q * (R(0.058823529411764705) +
               q * R(0.05263157894736842)))))))));
    return -R(2.0) * sum / (R(2.0) - s2);
}

// The cosine to the power n. pow of a cosine near 1 loses 3e-3 at n = 1e5 in float.
FN REAL cosine_power(REAL s2, REAL c2, REAL n) {
    return exp(R(0.5) * n * s2 * log_cosine_ratio(s2, c2));
}

// 1 - exp(-x), x >= 0.
FN REAL one_minus_exp(REAL x) {
    if (x > R(0.25)) return R(1.0) - exp(-x);
    REAL sum = R(1.0);
    for (int k = 13; k > 1; --k) sum = R(1.0) - x / REAL(k) * sum;
    return x * sum;
}

// The squared sine of a direction whose cosine has the density (n + 1) cos^n.
FN REAL sample_squared_sine(REAL u, REAL n) {
    return clamp(one_minus_exp(-R(2.0) * log(max(R(1.0) - u, R(1e-30))) / (n + R(1.0))),
                 R(0.0),
                 R(1.0));
}

// A direction of that squared sine around the normal.
FN VEC3 around_normal(REAL s2, REAL cos_phi, REAL sin_phi) {
    REAL s = sqrt(s2);
    return VEC3(s * cos_phi, s * sin_phi, sqrt(R(1.0) - s2));
}

FN VEC3 mirrored_about(VEC3 wo, VEC3 h) {
    return h * (R(2.0) * dot(wo, h)) - wo;
}
