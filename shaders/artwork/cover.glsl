// How much of a pixel's footprint a shape covers, in the subset of GLSL and C++
// (shaders/bsdf/prelude_glsl.glsl). The plane has s to the right and t up, in mm. A pixel covers a
// parallelogram of sides a and b around its point, every place of it alike: along any line across it
// the point is the sum of two boxes. A shape of one dimension is met exactly by differences of its
// integrals, one for each box.

// A side that is next to nothing beside the other would lose the difference's digits.
FN VEC2 box_sides(REAL a, REAL b, REAL least) {
    REAL floor_of = max(R(0.02) * max(abs(a), abs(b)), least);
    return VEC2(max(abs(a), floor_of), max(abs(b), floor_of));
}

FN REAL cube_over_6(REAL x) {
    REAL y = max(x, R(0.0));
    return y * y * y * R(0.16666666666666667);
}

// Mean of the step at 0, itself a ramp of width `soft`, over x + a u + b v with u, v in +-1/2.
FN REAL half_cover(REAL x, REAL a, REAL b, REAL soft) {
    VEC2 side = box_sides(a, b, R(0.01) * soft + R(1e-6));
    REAL ramp = max(soft, R(0.02) * max(side.x, side.y));
    REAL reach = R(0.5) * (side.x + side.y + ramp);
    if (x >= reach) return R(1.0);
    if (x <= -reach) return R(0.0);
    REAL sum = R(0.0);
    for (int k = 0; k < 8; ++k) {
        REAL i = (k & 1) != 0 ? R(0.5) : R(-0.5);
        REAL j = (k & 2) != 0 ? R(0.5) : R(-0.5);
        REAL l = (k & 4) != 0 ? R(0.5) : R(-0.5);
        sum += R(8.0) * i * j * l * cube_over_6(x + i * side.x + j * side.y + l * ramp);
    }
    return clamp(MUTATED(edge_cover, sum / (side.x * side.y * ramp)), R(0.0), R(1.0));
}

// The wave that is 1 over `width` around every multiple of `period` and 0 between, less its mean,
// integrated twice; even and periodic.
FN REAL wave_integral(REAL s, REAL period, REAL width) {
    REAL x = abs(s - period * floor(s / period + R(0.5)));
    REAL share = width / period;
    REAL gap = period - width;
    if (x <= R(0.5) * width) return R(0.5) * (R(1.0) - share) * x * x;
    REAL y = x - R(0.5) * period;
    return R(0.125) * ((R(1.0) - share) * width * width + share * gap * gap) -
           R(0.5) * share * y * y;
}

FN REAL stripes_cover(REAL s, REAL a, REAL b, REAL period, REAL width) {
    VEC2 side = box_sides(a, b, R(0.002) * period);
    // Near 0 first: far out, four places would be rounded each in its own way.
    REAL x = s - period * floor(s / period + R(0.5));
    REAL sum = R(0.0);
    for (int k = 0; k < 4; ++k) {
        REAL i = (k & 1) != 0 ? R(0.5) : R(-0.5);
        REAL j = (k & 2) != 0 ? R(0.5) : R(-0.5);
        sum += R(4.0) * i * j * wave_integral(x + i * side.x + j * side.y, period, width);
    }
    return clamp(MUTATED(stripes_cover, width / period) + sum / (side.x * side.y), R(0.0), R(1.0));
}

// Both dimensions are taken as independent: exact but where both edges of a check meet in a
// footprint that is askew.
FN REAL checks_part(VEC2 at, VEC2 a, VEC2 b, REAL size) {
    REAL half_size = R(0.5) * size;
    REAL p = R(2.0) * stripes_cover(at.x - half_size, a.x, b.x, R(2.0) * size, size) - R(1.0);
    REAL q = R(2.0) * stripes_cover(at.y - half_size, a.y, b.y, R(2.0) * size, size) - R(1.0);
    return R(0.5) + R(0.5) * p * q;
}

// Where the footprint is small beside a dot its edge is straight; where it is wide, the dots' share
// of the plane is what it sees.
FN REAL dots_part(VEC2 at, VEC2 a, VEC2 b, REAL period, REAL diameter) {
    REAL x = at.x - period * floor(at.x / period + R(0.5));
    REAL y = at.y - period * floor(at.y / period + R(0.5));
    REAL d = sqrt(x * x + y * y);
    REAL nx = d > R(0.0) ? x / d : R(1.0);
    REAL ny = d > R(0.0) ? y / d : R(0.0);
    REAL inside = half_cover(
        R(0.5) * diameter - d, a.x * nx + a.y * ny, b.x * nx + b.y * ny, R(0.0));
    REAL share = diameter / period;
    REAL mean = MUTATED(dots_cover, R(0.7853981633974483) * share * share);
    REAL widest = sqrt(max(a.x * a.x + a.y * a.y, b.x * b.x + b.y * b.y)) / period;
    return mix(inside, mean, clamp(R(4.0) * widest - R(1.0), R(0.0), R(1.0)));
}

// Of a footprint that is not small beside the shape, in sixteen parts.
FN REAL plane_cover(bool checks, VEC2 at, VEC2 a, VEC2 b, REAL size, REAL share) {
    REAL widest = max(a.x * a.x + a.y * a.y, b.x * b.x + b.y * b.y);
    int side = widest > R(0.01) * share * share * size * size ? 4 : 1;
    REAL scale = R(1.0) / REAL(side);
    REAL sum = R(0.0);
    for (int k = 0; k < side * side; ++k) {
        REAL u = (REAL(k % side) + R(0.5)) * scale - R(0.5);
        REAL v = (REAL(k / side) + R(0.5)) * scale - R(0.5);
        VEC2 place = at + u * a + v * b;
        sum += checks ? checks_part(place, scale * a, scale * b, size)
                      : dots_part(place, scale * a, scale * b, size, share * size);
    }
    return sum * scale * scale;
}

// Of each shape but the picture, in the order of ArtworkShape.
FN REAL shape_cover(int shape, VEC2 at, VEC2 a, VEC2 b, REAL size, REAL share, REAL soft) {
    if (shape == 0) return half_cover(at.y, a.y, b.y, soft);
    if (shape == 1) return stripes_cover(at.x, a.x, b.x, size, share * size);
    return plane_cover(shape == 2, at, a, b, size, shape == 2 ? R(1.0) : share);
}

// Surfaces that face away from the projection wear nothing; where they turn away, it fades.
FN REAL facing_cover(REAL cosine) {
    return clamp(cosine * R(20.0), R(0.0), R(1.0));
}
