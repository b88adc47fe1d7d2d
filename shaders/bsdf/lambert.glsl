// Lambert: the same radiance in all directions. Local coordinates: z the normal, x the tangent.

struct LambertPrepared {
    VEC3 diffuse;
};

FN int lobe_count(LambertPrepared q) {
    return 0;
}

FN VEC2 slopes_of(LambertPrepared q, int lobe) {
    return VEC2(R(1.0), R(1.0));
}

FN LambertPrepared lambert_prepare(IN(BsdfParameters) p) {
    LambertPrepared q;
    q.diffuse = p.diffuse;
    return q;
}

FN VEC3 lambert_eval(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return VEC3(R(0.0));
    return MUTATED(lambert, p.diffuse * R(0.3183098861837907));
}

FN VEC3 lambert_sample(IN(BsdfParameters) p, VEC3 wo, VEC3 u) {
    return cosine_sample(VEC2(u.x, u.y));
}

FN REAL lambert_pdf(IN(BsdfParameters) p, VEC3 wi, VEC3 wo) {
    if (wi.z <= R(0.0) || wo.z <= R(0.0)) return R(0.0);
    return wi.z * R(0.3183098861837907);
}

FN BsdfEnvironment lambert_environment(IN(BsdfParameters) p, REAL mu) {
    BsdfEnvironment e;
    e.diffuse = MUTATED(lambert_sky_weight, p.diffuse);
    e.specular = VEC3(R(0.0));
    e.coat = VEC3(R(0.0));
    return e;
}
