// Gamut mapping of one colour: constant hue in Oklab, soft knees, chroma before lightness. Read by
// correct.comp and by src/compensation/gamut_kernel.cpp, which say REAL, VEC3, R, FN, IN, AND (of two
// conditions that both may be looked at), PRECISE (of sums that both round alike), FLOAT_BITS and
// BITS_FLOAT.

const REAL kChromaKnee = R(0.85);
// Tighter: a wider one would grey the design white itself.
const REAL kLightnessKnee = R(0.95);
const REAL kStretch = R(1.0) / kChromaKnee;
const int kHalvings = 18;

struct Rows {
    VEC3 x, y, z;
};

struct Oklab {
    Rows cones;  // from working RGB
    Rows lab;    // from the cones' cube roots
    Rows roots;  // and back
    Rows rgb;
};

// The colours whose N = rows * rgb + offset lies in the unit cube.
struct Gamut {
    VEC3 red, green, blue, offset;
};

FN REAL along(VEC3 row, VEC3 v) {
    PRECISE REAL sum = row.x * v.x + row.y * v.y + row.z * v.z;
    return sum;
}

FN VEC3 times(IN(Rows) m, VEC3 v) { return VEC3(along(m.x, v), along(m.y, v), along(m.z, v)); }

FN VEC3 n_of(IN(Gamut) gamut, VEC3 c) {
    PRECISE REAL red = along(gamut.red, c) + gamut.offset.x;
    PRECISE REAL green = along(gamut.green, c) + gamut.offset.y;
    PRECISE REAL blue = along(gamut.blue, c) + gamut.offset.z;
    return VEC3(red, green, blue);
}

FN bool in_cube(VEC3 n) {
    return (n.x >= R(0.0)) AND (n.x <= R(1.0)) AND (n.y >= R(0.0)) AND (n.y <= R(1.0))
           AND (n.z >= R(0.0)) AND (n.z <= R(1.0));
}

// Cube root to the last bit or two: a guess from the exponent and two of Halley's steps.
FN REAL cube_root(REAL x) {
    REAL size = x < R(0.0) ? -x : x;
    REAL third = REAL(FLOAT_BITS(size)) * (R(1.0) / R(3.0));
    REAL y = BITS_FLOAT(int(third) + 709982100);
    for (int k = 0; k < 2; ++k) {
        REAL cube = y * y * y;
        y *= (cube + R(2.0) * size) / (R(2.0) * cube + size);
    }
    y = size > R(1e-30) ? y : R(0.0);
    return x < R(0.0) ? -y : y;
}

FN VEC3 lab_of_cones(IN(Oklab) m, VEC3 cones) {
    return times(m.lab, VEC3(cube_root(cones.x), cube_root(cones.y), cube_root(cones.z)));
}

FN VEC3 rgb_of_lab(IN(Oklab) m, VEC3 lab) {
    VEC3 root = times(m.roots, lab);
    return times(m.rgb,
                 VEC3(root.x * root.x * root.x, root.y * root.y * root.y, root.z * root.z * root.z));
}

FN VEC3 with_chroma(VEC3 lab, REAL scale) { return VEC3(lab.x, lab.y * scale, lab.z * scale); }

// The colour whose place relative to the boundary tells whether `rgb` is beyond the chroma's knee.
FN VEC3 stretched(IN(Oklab) m, VEC3 lab) { return rgb_of_lab(m, with_chroma(lab, kStretch)); }

// Whether lightness is between the knees.
FN bool is_lit(REAL lightness, REAL darkest, REAL brightest) {
    return (lightness >= darkest * kStretch) AND (lightness <= kLightnessKnee * brightest);
}

// t / (1 + t^3)^(1/3): the identity near 0, towards 1; the least that is 1 to the last bit stands
// for all beyond.
FN REAL bend(REAL t) {
    REAL x = t < R(1e4) ? t : R(1e4);
    return x / cube_root(R(1.0) + x * x * x);
}

// The identity up to `knee`, then bends towards 1 with slope 1 at the knee; rising everywhere.
FN REAL soft(REAL x, REAL knee) {
    return x <= knee ? x : knee + (R(1.0) - knee) * bend((x - knee) * (R(1.0) / (R(1.0) - knee)));
}

// Lightness as the neighbourhood can show it: moved only where no neutral of it can be shown.
FN REAL bent_lightness(REAL lightness, REAL darkest, REAL brightest) {
    REAL above = darkest * kStretch;
    REAL knee = above < brightest ? above : brightest;
    REAL room = knee - darkest > R(1e-12) ? knee - darkest : R(1e-12);
    REAL raised = knee - room * bend((knee - lightness) / room);
    REAL l = (lightness < knee) AND (knee > darkest) ? raised : lightness;
    REAL relative = l / brightest;
    REAL bent = brightest * soft(relative, kLightnessKnee);
    return relative <= kLightnessKnee ? l : bent;
}

// What chroma is multiplied by when `boundary` of the stretched one is reached; `inside`: all of it.
FN REAL chroma_scale(REAL boundary, bool inside) {
    REAL far = boundary * kStretch;  // in units of the wanted chroma
    REAL kept = far * soft(R(1.0) / (far > R(1e-6) ? far : R(1e-6)), kChromaKnee);
    return kChromaKnee * (inside ? R(1.0) : kept);
}

// The nearest lightness that the pixel itself can show of a neutral, a hair inside: Oklab's
// neutrals, by its rounded matrices, are D65 to about 1e-4 only.
FN REAL own_lightness(REAL lightness, REAL darkest, REAL brightest) {
    REAL margin = R(5e-4) * (brightest - darkest);
    REAL high = brightest - margin, low = darkest + margin;
    REAL under = lightness < high ? lightness : high;
    return under > low ? under : low;
}
