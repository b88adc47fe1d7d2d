// Single flakes: what a lobe of flakes shows of itself where a pixel holds few of them that face
// the light. In the subset of disc.glsl, with WORD, an unsigned integer of 32 bits that wraps, and
//   word_of(x)    a whole number as one        INOUT(T)      an argument that is changed
//   unit_of(w)    its upper bits in (0, 1)     octave_of(x)  the power of two at or below x > 0
// from shaders/bsdf/prelude_glsl.glsl and its C++ counterparts.
//
// Of n flakes under a pixel each faces half way between light and eye with the chance p, which is
// the lobe's share of slopes within the disc that counts (disc.glsl's, and a flake's own lobe). How
// many do is a binomial count K, and the lobe is drawn K / (n p) times as bright: 1 in the mean,
// with the variance (1 - p) / (n p). K belongs to a place on the surface and a half vector. These
// are five numbers; in a grid over them the six corners of the simplex around a point hold the
// flakes by their weights w in it (Deliot and Belcour 2023 split them alike), and so do two grids,
// the coarser one of twice the size, by how large the pixel is. Counts of separate flakes add, so
// the sum has exactly the mean and the variance of the whole, everywhere in a cell, and changes
// without a step.
//
// A corner's share of the factor is w X, where X has the mean 1 and the variance v = V / w, and is a
// monotone function of one hashed number. Flakes differ in size, so X is no whole number:
//   v <= 1/3  evenly distributed: 1 + sqrt(12 v) (1/2 - u)
//   v >  1/3  mostly nothing: 2 max(0, q - u) / q^2, q = 4 / (3 (1 + v)), whose mean is 1 and whose
//             second moment is 4 / (3 q)
// Both are 2 (1 - u) at 1/3, and w X goes to 0 with w. Sums over corners and grids come close to a
// Gaussian where flakes are many.

// Radius in slopes of the half vectors for which one flake shines, squared: 0.02. Diffraction by a
// flake of 20 micrometres (wavelength / size, half of it for the half vector) is 0.014, and it is
// not flat.
#define GLINT_RADIUS2 R(4e-4)
// No flake shines brighter than about this many times the lobe, times 3/2: chances go to 0.
#define GLINT_LARGEST_VARIANCE R(1000.0)
#define GLINT_SMALLEST_CELL R(0.0009765625)
#define GLINT_LARGEST_CELL R(1024.0)

// By falling fraction; the steps go with them.
FN void glint_order(INOUT(REAL) a, INOUT(WORD) step_a, INOUT(REAL) b, INOUT(WORD) step_b) {
    REAL larger = max(a, b);
    REAL smaller = min(a, b);
    WORD step_of_larger = a < b ? step_b : step_a;
    WORD step_of_smaller = a < b ? step_a : step_b;
    a = larger;
    b = smaller;
    step_a = step_of_larger;
    step_b = step_of_smaller;
}

FN WORD glint_hash(WORD x) {
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    x ^= x >> 16u;
    return x;
}

// w X of a corner.
FN REAL glint_share(WORD corner, REAL weight, REAL variance) {
    REAL u = unit_of(glint_hash(corner));
    REAL sum = weight + variance;
    REAL q = R(1.3333333333333333) * weight / max(sum, R(1e-30));
    REAL few = MUTATED(glint_few, R(1.5) * sum) * max(q - u, R(0.0)) / max(q, R(1e-9));
    REAL many = MUTATED(glint_many, weight) + sqrt(R(12.0) * variance * weight) * (R(0.5) - u);
    return R(3.0) * variance > weight ? few : many;
}

// The share `weight` of the factor, from the grid of that cell size.
FN REAL glint_grid(VEC3 position_mm, VEC2 half_vector, REAL cell_mm, REAL weight, REAL variance) {
    REAL a = position_mm.x / cell_mm;
    REAL b = position_mm.y / cell_mm;
    REAL c = position_mm.z / cell_mm;
    REAL d = half_vector.x;
    REAL e = half_vector.y;
    WORD step_a = word_of(R(1.0)) * 0x9e3779b1u;
    WORD step_b = word_of(R(1.0)) * 0x85ebca77u;
    WORD step_c = word_of(R(1.0)) * 0xc2b2ae3du;
    WORD step_d = word_of(R(1.0)) * 0x27d4eb2fu;
    WORD step_e = word_of(R(1.0)) * 0x165667b1u;
    WORD corner = word_of(floor(a)) * step_a + word_of(floor(b)) * step_b +
                  word_of(floor(c)) * step_c + word_of(floor(d)) * step_d +
                  word_of(floor(e)) * step_e + word_of(cell_mm * R(2048.0)) * 0x2545f491u;
    a -= floor(a);
    b -= floor(b);
    c -= floor(c);
    d -= floor(d);
    e -= floor(e);
    glint_order(a, step_a, d, step_d);
    glint_order(b, step_b, e, step_e);
    glint_order(a, step_a, c, step_c);
    glint_order(b, step_b, d, step_d);
    glint_order(a, step_a, b, step_b);
    glint_order(c, step_c, e, step_e);
    glint_order(b, step_b, c, step_c);
    glint_order(d, step_d, e, step_e);
    glint_order(c, step_c, d, step_d);
    REAL sum = glint_share(corner, weight * (R(1.0) - a), variance);
    corner += step_a;
    sum += glint_share(corner, weight * (a - b), variance);
    corner += step_b;
    sum += glint_share(corner, weight * (b - c), variance);
    corner += step_c;
    sum += glint_share(corner, weight * (c - d), variance);
    corner += step_d;
    sum += glint_share(corner, weight * (d - e), variance);
    corner += step_e;
    return sum + glint_share(corner, weight * e, variance);
}

// The chance that a flake of a lobe shines, for a light and a pixel as in disc.glsl: an integral of
// the mean that is derived there.
FN REAL glint_chance(VEC3 wi,
                     VEC3 wo,
                     REAL hh,
                     REAL alpha,
                     REAL light_radius2,
                     REAL mean_squared_slope) {
    REAL hx = wi.x + wo.x;
    REAL hy = wi.y + wo.y;
    REAL hz = wi.z + wo.z;
    REAL h = sqrt(hh);
    REAL c = max(hz / h, R(0.5));
    REAL r2 = R(0.5) * light_radius2 / (h * c * c * c) + R(2.0) * mean_squared_slope +
              GLINT_RADIUS2;
    REAL hz2 = hz * hz;
    REAL a2 = alpha * alpha;
    REAL b = hx * hx + hy * hy + hz2 * (a2 - r2);
    REAL cross_term = R(4.0) * r2 * a2 * hz2 * hz2;
    REAL q = max(sqrt(b * b + cross_term), R(1e-18));
    REAL chance = b > R(0.0) ? cross_term / (q * (q + b)) : (q - b) / q;
    return clamp(MUTATED(glint_chance, R(0.5) * chance), R(1e-12), R(1.0));
}

// What a lobe is multiplied by. `place` has the position and the side of the square that a pixel
// covers there, in mm; `density` are flakes on a mm^2.
FN REAL glint_factor(VEC3 wi,
                     VEC3 wo,
                     REAL hh,
                     REAL alpha,
                     REAL light_radius2,
                     REAL mean_squared_slope,
                     VEC4 place,
                     REAL density) {
    REAL chance = glint_chance(wi, wo, hh, alpha, light_radius2, mean_squared_slope);
    REAL expected = MUTATED(glint_count, density * place.w * place.w) * chance;
    REAL variance = min((R(1.0) - chance) / max(expected, R(1e-30)), GLINT_LARGEST_VARIANCE);
    REAL side = clamp(place.w, GLINT_SMALLEST_CELL, GLINT_LARGEST_CELL);
    REAL octave = octave_of(side);
    REAL coarse = side / octave - R(1.0);
    // As far apart as the light's own picture among the half vectors is wide
    REAL spacing = sqrt(hh * (R(0.25) * light_radius2 + GLINT_RADIUS2));
    VEC2 half_vector = VEC2((wi.x + wo.x) / spacing, (wi.y + wo.y) / spacing);
    VEC3 position_mm = VEC3(place.x, place.y, place.z);
    return glint_grid(
               position_mm, half_vector, R(0.5) * octave, R(1.0) - coarse, variance) +
           glint_grid(position_mm, half_vector, octave, coarse, variance);
}
