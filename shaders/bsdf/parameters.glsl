// Parameters of every model, colours in the working space. Ranges: docs/materials.md.

struct BsdfParameters {
    VEC3 diffuse;             // albedo of the diffuse layer
    VEC3 f0;                  // Fresnel reflectance of the base at normal incidence
    REAL alpha_x;             // slope parameter along the tangent
    REAL alpha_y;             // slope parameter across it
    VEC3 flake_f0;            // reflectance of the second lobe of flakes
    REAL flake_alpha;         // its slope parameter
    REAL film_nm;             // thickness of the film on those flakes, 0 for none
    REAL film_eta;            // its index
    REAL glint_density_per_mm2;  // of those flakes on the product, 0 for no glints
    REAL glint_scale;         // how many times larger than they are they are drawn
    REAL coat_alpha;          // slope parameter of the coat
    REAL coat_f0;             // Fresnel reflectance of the coat at normal incidence
    VEC3 coat_transmittance;  // of the coat, once through at normal incidence
    VEC3 specular;            // scale of a lobe without a Fresnel term
    REAL exponent_x;          // cosine exponent along the tangent
    REAL exponent_y;          // cosine exponent across it
    REAL diffuse_roughness;   // of a diffuse surface by itself: 0 Lambert, 1 rough as sand
};

// What a model does to light from all around, seen under the cosine mu:
// radiance = diffuse * irradiance / pi + specular * mean radiance around the mirror direction
// within the base's lobe + coat * the same within the coat's lobe.
struct BsdfEnvironment {
    VEC3 diffuse;
    VEC3 specular;
    VEC3 coat;
};

// Widened lobes for a patch whose normals vary by `mean_squared_slope` (both axes together) around
// its mean normal. A GGX or Beckmann slope parameter is alpha^2 = 2 sigma^2 with sigma^2 the slope
// variance of one axis, so alpha'^2 = alpha^2 + 2 (mean_squared_slope / 2). Olano and Baker, LEAN
// mapping (2010); Kaplanyan et al., Filtering distributions of normals (2016). A cosine exponent n
// stands for alpha^2 = 2 / (n + 2).
FN REAL widened_exponent(REAL exponent, REAL mean_squared_slope) {
    REAL n2 = exponent + R(2.0);
    return max(n2 / (R(1.0) + R(0.5) * mean_squared_slope * n2) - R(2.0), R(0.0));
}

FN BsdfParameters bsdf_widen(IN(BsdfParameters) p, REAL mean_squared_slope) {
    BsdfParameters q = p;
    q.alpha_x = min(sqrt(p.alpha_x * p.alpha_x + mean_squared_slope), R(1.0));
    q.alpha_y = min(sqrt(p.alpha_y * p.alpha_y + mean_squared_slope), R(1.0));
    q.flake_alpha = min(sqrt(p.flake_alpha * p.flake_alpha + mean_squared_slope), R(1.0));
    q.coat_alpha = min(sqrt(p.coat_alpha * p.coat_alpha + mean_squared_slope), R(1.0));
    q.exponent_x = widened_exponent(p.exponent_x, mean_squared_slope);
    q.exponent_y = widened_exponent(p.exponent_y, mean_squared_slope);
    return q;
}

FN VEC3 cosine_sample(VEC2 u) {
    REAL r = sqrt(u.x);
    REAL phi = R(6.283185307179586) * u.y;
    return VEC3(r * cos(phi), r * sin(phi), sqrt(max(R(1.0) - u.x, R(0.0))));
}

FN REAL mean_component(VEC3 v) {
    return (v.x + v.y + v.z) * R(0.3333333333333333);
}

// Chances of sampling a lobe and the diffuse layer under it, by what each returns. Both are told:
// one minus the other would lose the smaller one's digits.
FN VEC2 lobe_chances(VEC3 lobe, VEC3 diffuse) {
    REAL l = mean_component(lobe);
    REAL d = mean_component(diffuse);
    return l + d > R(0.0) ? VEC2(l / (l + d), d / (l + d)) : VEC2(R(0.0), R(1.0));
}
