// Half and difference coordinates of a pair of directions (Rusinkiewicz 1998), and where they lie on
// a grid of measured reflectance. Local coordinates: z the normal.
//
// theta_h is the half vector's angle to the normal, theta_d the light's to the half vector and phi_d
// the light's azimuth around it, from the plane that holds both. An isotropic surface needs no
// more. Light and eye exchanged turn phi_d by pi: folding it to [0, pi) makes reflectance
// reciprocal.
//
// No angle is taken from its cosine, and the difference vector wi - wo is used for wi: it has no
// part along the half vector that would have to cancel.
FN VEC3 half_difference(VEC3 wi, VEC3 wo) {
    VEC3 h = wi + wo;
    VEC3 d = wi - wo;
    REAL tangential = sqrt(h.x * h.x + h.y * h.y);
    REAL along = sqrt(dot(h, h));
    REAL apart = sqrt(dot(d, d));
    REAL theta_h = MUTATED(half_angle, atan(tangential, h.z));
    REAL theta_d = MUTATED(difference_angle, atan(apart, along));
    // phi_d turns freely where one of the two is 0, and nothing depends on it there.
    REAL phi_d = R(0.0);
    if (tangential > R(1e-6) * along && apart > R(1e-6)) {
        REAL x = (h.z * (h.x * d.x + h.y * d.y) / tangential - tangential * d.z) / along;
        REAL y = (h.x * d.y - h.y * d.x) / tangential;
        phi_d = atan(y, x);
        if (phi_d < R(0.0)) phi_d += R(3.141592653589793);
        if (phi_d >= R(3.141592653589793)) phi_d = R(0.0);
    }
    return VEC3(theta_h, theta_d, phi_d);
}

// In nodes of a grid of size.x by size.y by size.z along theta_h, theta_d and phi_d. theta_h steps
// with its root, for lobes are narrow; its nodes and theta_d's include both ends, phi_d goes round.
FN VEC3 half_difference_nodes(VEC3 angles, VEC3 size) {
    REAL per_right_angle = R(0.6366197723675814);
    REAL h = sqrt(clamp(angles.x * per_right_angle, R(0.0), R(1.0)));
    REAL d = clamp(angles.y * per_right_angle, R(0.0), R(1.0));
    return VEC3(h * (size.x - R(1.0)),
                d * (size.y - R(1.0)),
                angles.z * R(0.3183098861837907) * size.z);
}
