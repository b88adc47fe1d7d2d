// The unit direction from which a surface of unit normal n is shaded for an eye in the unit
// direction wo, in the subset of GLSL and C++. Where the eye sees it that is wo, 1e-4 above the
// horizon at least. What faces away the eye cannot see, yet the projector lights it and others see
// it: it is shaded as from above the horizon, of the cosine 1 - (1 - |c|)^3 where wo has c < 0, in
// the plane of both. So there is no step at the horizon, and of the Fresnel reflection at 90 degrees
// no more than a narrow band; opposite to the eye it is the normal. No quotient is near 0 by 0.
FN VEC3 seen_from(VEC3 wo, VEC3 n) {
    REAL c = dot(wo, n);
    REAL away = clamp(-c, R(0.0), R(1.0));
    REAL left = R(1.0) - away;
    REAL cosine = max(max(c, R(1.0) - left * left * left), R(1e-4));
    // (1 - cosine^2) / (1 - c^2), the first factors of which make left^2
    REAL along = left * sqrt((R(1.0) + cosine) / (R(1.0) + max(c, away)));
    return (wo - n * c) * along + n * cosine;
}
