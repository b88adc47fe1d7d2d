// Directional albedo of a model's lobe by quadrature in the lobe's own coordinates, for models
// without a fit of it. Needs one evaluation a point, so whoever shades many fragments tabulates it
// over the cosine.

// The same lobe, round, without what lies under it.
FN BsdfParameters round_lobe(IN(BsdfParameters) p) {
    BsdfParameters q = p;
    q.diffuse = VEC3(R(0.0));
    q.alpha_x = sqrt(p.alpha_x * p.alpha_y);
    q.alpha_y = q.alpha_x;
    q.exponent_x = sqrt(p.exponent_x * p.exponent_y);
    q.exponent_y = q.exponent_x;
    return q;
}

// Defines NAME(p, mu) from the model's own functions.
#define LOBE_ALBEDO(NAME, EVAL, SAMPLE, PDF)                                            \
    FN VEC3 NAME(IN(BsdfParameters) p, REAL mu) {                                           \
        BsdfParameters q = round_lobe(p);                                               \
        REAL c = clamp(mu, R(1e-4), R(1.0));                                            \
        VEC3 wo = VEC3(sqrt((R(1.0) - c) * (R(1.0) + c)), R(0.0), c);                   \
        VEC3 sum = VEC3(R(0.0));                                                        \
        for (int i = 0; i < 12; ++i) {                                                  \
            for (int j = 0; j < 12; ++j) {                                              \
                VEC3 u = VEC3((REAL(i) + R(0.5)) / R(12.0),                             \
                              (REAL(j) + R(0.5)) / R(12.0),                             \
                              R(0.0));                                                  \
                VEC3 wi = SAMPLE(q, wo, u);                                             \
                REAL density = PDF(q, wi, wo);                                          \
                if (density > R(0.0)) sum += EVAL(q, wi, wo) * (wi.z / density);        \
            }                                                                           \
        }                                                                               \
        return MUTATED(lobe_albedo, sum * R(0.006944444444444444));                     \
    }

FN BsdfEnvironment diffuse_and_lobe(VEC3 diffuse, VEC3 specular) {
    BsdfEnvironment e;
    e.diffuse = diffuse;
    e.specular = specular;
    e.coat = VEC3(R(0.0));
    return e;
}
