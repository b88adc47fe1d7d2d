// Interference in a thin film on a flake: pearl and colour-shifting pigments.
//
// A flake that reflects f0 in the varnish carries a film of an index and a thickness. Light that
// goes through it and back, x nanometres further, meets what its front reflects. With the amplitudes
// r12 of the front and r23 of the back and rho = r12 r23 Airy's sum is, of one wavelength,
//   R = 1 - A (1 + 2 sum_m (-rho)^m cos(2 pi m x / wavelength)),
//   A = (1 - r12^2) (1 - r23^2) / (1 - rho^2),
// and of a channel the same with S(m x), the cosine's mean over what the channel sees of daylight.
// Without a film S = 1 and R = f0 (which gives r23), so
//   R = f0 + 2 A sum_m (-rho)^m (1 - S(m x)):
// nothing cancels for thin films, and the terms beyond the fourth are summed as if they were all as
// thick as the fifth. Amplitudes are those along the normal, the same for both polarisations.

// S: ten bands, even in wavenumber and of one Gaussian shape, fitted to the CIE 1931 observer's
// view of D65 in the working space; at most 0.0075 off.
#define FILM_BAND(r, g, b)                     \
    sum += VEC3(R(r), R(g), R(b)) * at.x;      \
    at = VEC2(at.x * turn.x - at.y * turn.y, at.x * turn.y + at.y * turn.x);

FN VEC2 film_turn(REAL turns) {
    REAL angle = R(6.283185307179586) * (turns - floor(turns + R(0.5)));
    return VEC2(cos(angle), sin(angle));
}

FN VEC3 film_coherence(REAL x_nm) {
    VEC2 turn = film_turn(R(8.686640551e-05) * x_nm);
    VEC2 at = film_turn(R(1.553499748e-03) * x_nm);
    VEC3 sum = VEC3(R(0.0));
    FILM_BAND(0.075644, -0.004271, 0.001114)
    FILM_BAND(0.593309, -0.019742, 0.000640)
    FILM_BAND(0.308160, 0.237973, -0.005129)
    FILM_BAND(0.096320, 0.379707, -0.009457)
    FILM_BAND(-0.064482, 0.343306, -0.001921)
    FILM_BAND(-0.044028, 0.095123, 0.035750)
    FILM_BAND(-0.024529, 0.043403, 0.106266)
    FILM_BAND(0.008848, -0.020368, 0.379358)
    FILM_BAND(0.034606, -0.035897, 0.337859)
    FILM_BAND(0.016152, -0.019234, 0.155520)
    return MUTATED(film_coherence, exp2(R(-1.035104596e-07) * x_nm * x_nm) * sum);
}

struct FilmPrepared {
    REAL nm;         // thickness of the film, 0 for none
    REAL eta;        // its index
    VEC3 f0;         // of the flake without it
    VEC3 minus_rho;  // -r12 r23
    VEC3 twice_a;    // 2 A
    VEC3 most;       // what any film of this index reflects of any wavelength, at most
};

FN FilmPrepared film_prepare(IN(BsdfParameters) p) {
    FilmPrepared film;
    film.nm = p.film_nm;
    film.eta = p.film_eta;
    film.f0 = p.flake_f0;
    film.minus_rho = VEC3(R(0.0));
    film.twice_a = VEC3(R(0.0));
    film.most = p.flake_f0;
    if (p.film_nm <= R(0.0)) return film;
    VEC3 one = VEC3(R(1.0));
    // r12, of the film's front in a varnish whose index follows from coat_f0
    REAL r = sqrt(p.coat_f0);
    REAL index = (R(1.0) + r) / (R(1.0) - r);
    REAL front = (index - p.film_eta) / (index + p.film_eta);
    // -r23, such that both without a path between them reflect f0
    VEC3 whole = sqrt(p.flake_f0);
    VEC3 back = (whole + VEC3(front)) / (one + whole * front);
    VEC3 rho = back * front;
    film.minus_rho = rho;  // back is turned already
    film.twice_a =
        MUTATED(film_airy,
                R(2.0) * (one - back * back) * (R(1.0) - front * front) / (one - rho * rho));
    VEC3 a = VEC3(max(front, -front));
    VEC3 b = max(back, VEC3(R(0.0)) - back);
    VEC3 root = (a + b) / (one + a * b);
    film.most = root * root;
    return film;
}

// Of the flake under its film. hh = |wi + wo|^2: 4 cos^2 of the angle under which the flake is met,
// outside of the varnish.
FN VEC3 film_reflectance(IN(FilmPrepared) film, REAL hh) {
    if (!PRESENT(film.nm)) return film.f0;
    VEC3 one = VEC3(R(1.0));
    REAL sine2 = max(R(1.0) - R(0.25) * hh, R(0.0)) / (film.eta * film.eta);
    REAL x_nm = MUTATED(film_path, R(2.0) * film.eta * film.nm * sqrt(R(1.0) - sine2));
    VEC3 minus = film.minus_rho;
    VEC3 power = minus;
    VEC3 sum = power * (one - film_coherence(x_nm));
    power = power * minus;
    sum += power * (one - film_coherence(R(2.0) * x_nm));
    power = power * minus;
    sum += power * (one - film_coherence(R(3.0) * x_nm));
    power = power * minus;
    sum += power * (one - film_coherence(R(4.0) * x_nm));
    power = power * minus / (one - minus);
    sum += power * (one - film_coherence(R(5.0) * x_nm));
    // A channel of the working space has negative parts; no wavelength returns less or more.
    return min(max(film.f0 + film.twice_a * sum, VEC3(R(0.0))), film.most);
}
