// What the models of layers have in common: each takes from its parameters once what depends on no
// direction, in a struct of its own, and says of that struct q
//   lobe_count(q), slopes_of(q, lobe)    how many lobes mirror, and the slope parameters of one
//   passage_of(q, mu)                    what the layers let through
//   reflected(q, from, to, hh, lobes)    the value, given each lobe's distribution and visibility
//   sky_weight(q, to), mirror_weight(q, to, mu, grazing, lobe)
//                                        of light from all around: seen by the diffuse layer, and
//                                        mirrored by a lobe
//   evaluate(q, wi, wo)                  the value for a light without size on a smooth surface
//   sampled(q, wo, u), density(q, wi, wo)
//                                        a direction for light that leaves along wo, and how dense
//                                        such directions are
// What shades (shaders/radiance/shade.glsl) calls the same functions with means over a pixel.

// In a VEC3 of lobes
#define BASE_LOBE 0
#define COAT_LOBE 1
#define FLAKE_LOBE 2

// What passes the layers between a direction and the diffuse layer.
struct Passage {
    VEC3 base;  // the lobes over the diffuse layer
    REAL coat;  // the coat's interface
    REAL path;  // through a coat of thickness 1
};

// How many times as much of the light that lobes mirror grazes as does of even light, for lobes of
// .02, .042, .06; .085, .12, .17; .24, .5 and 1, and how much of it enters a coat grazing, for lobes
// of .06, .17 and .5 (src/radiance/light/mirror_quadrature.h).
struct MirrorGrazing {
    VEC3 narrow;
    VEC3 middle;
    VEC3 wide;
    VEC3 entry;
};

FN MirrorGrazing even_light() {
    MirrorGrazing g;
    g.narrow = VEC3(R(1.0));
    g.middle = VEC3(R(1.0));
    g.wide = VEC3(R(1.0));
    g.entry = VEC3(R(1.0));
    return g;
}

// What three lobes have, for one in between: each at the end of its interval.
FN REAL between_lobes(REAL below, VEC3 at, REAL alpha, VEC3 begins, VEC3 inverse_widths) {
    VEC3 share = (VEC3(alpha) - begins) * inverse_widths;
    share = min(max(share, VEC3(R(0.0))), VEC3(R(1.0)));
    return mix(mix(mix(below, at.x, share.x), at.y, share.y), at.z, share.z);
}

// Of a lobe's own Fresnel term. A mirror takes light from one direction only.
FN REAL grazing_fresnel(IN(MirrorGrazing) g, REAL alpha) {
    REAL value = between_lobes(R(1.0),
                               g.narrow,
                               alpha,
                               VEC3(R(0.0), R(0.02), R(0.042)),
                               VEC3(R(50.0), R(45.454545), R(55.555556)));
    value = between_lobes(value,
                          g.middle,
                          alpha,
                          VEC3(R(0.06), R(0.085), R(0.12)),
                          VEC3(R(40.0), R(28.571429), R(20.0)));
    return between_lobes(value,
                         g.wide,
                         alpha,
                         VEC3(R(0.17), R(0.24), R(0.5)),
                         VEC3(R(14.285714), R(3.8461538), R(2.0)));
}

// Of the coat above it.
FN REAL grazing_entry(IN(MirrorGrazing) g, REAL alpha) {
    return between_lobes(R(1.0),
                         g.entry,
                         alpha,
                         VEC3(R(0.0), R(0.06), R(0.17)),
                         VEC3(R(16.666667), R(9.0909091), R(3.030303)));
}
