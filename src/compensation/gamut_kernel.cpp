// Gamut mapping of a block of pixels. Most pixels of most pictures lie well inside: one loop finds
// those that do not, and only they are gathered and moved. The formulas are the shader's own.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/glm.hpp>

#include "compensation/drive_table.h"
#include "compensation/gamut.h"
#include "compensation/kernel.h"

#define LIVERY_ALWAYS_INLINE inline __attribute__((always_inline))
/// Of a loop over pixels: no pixel reads what another has written.
#define LIVERY_INDEPENDENT _Pragma("GCC ivdep")

namespace livery::kernel {
namespace {

/// No more than what the shared source says of a vector, so that loops over pixels stay simple.
struct Vector {
    float x, y, z;
    Vector() = default;
    Vector(float its_x, float its_y, float its_z) : x(its_x), y(its_y), z(its_z) {}
};

#define REAL float
#define VEC3 Vector
#define R(x) static_cast<float>(x)
#define FN LIVERY_ALWAYS_INLINE
#define IN(T) const T&
#define AND &
#define PRECISE
#define FLOAT_BITS(x) std::bit_cast<std::int32_t>(x)
#define BITS_FLOAT(x) std::bit_cast<float>(x)
#include "shaders/compensation/gamut.glsl"
#undef REAL
#undef VEC3
#undef R
#undef FN
#undef IN
#undef AND
#undef PRECISE
#undef FLOAT_BITS
#undef BITS_FLOAT

/// So many are moved at once.
constexpr std::size_t kMost = 128;

/// Plain arrays: checked ones would put a branch into every loop.
using Row = float[kMost];
struct alignas(64) Colours {
    Row x, y, z;
};
/// n = a * rgb + b of each pixel, as in the table.
struct alignas(64) Gamuts {
    Row rows[12];
};

struct Matrices {
    Oklab oklab;
    glm::dmat3 exact_cones;  ///< oklab.cones before rounding
};

Rows rows_of(const glm::dmat3& m) {
    const auto row = [&](int i) {
        return Vector(
            static_cast<float>(m[0][i]), static_cast<float>(m[1][i]), static_cast<float>(m[2][i]));
    };
    return {row(0), row(1), row(2)};
}

const Matrices& matrices() {
    static const OklabMatrices exact = oklab_matrices();
    static const Matrices all{
        {rows_of(exact.cones), rows_of(exact.lab), rows_of(exact.roots), rows_of(exact.rgb)},
        exact.cones};
    return all;
}

LIVERY_ALWAYS_INLINE Vector lab_of(const Oklab& m, Vector c) {
    return lab_of_cones(m, times(m.cones, c));
}

/// Saturated colours leave next to nothing to one kind of cones, and its root makes much of what
/// floats round away: doubles for colours that are moved.
LIVERY_ALWAYS_INLINE Vector exact_lab_of(const Matrices& m, Vector c) {
    const double r = static_cast<double>(c.x), g = static_cast<double>(c.y),
                 b = static_cast<double>(c.z);
    const auto cone = [&](int row) __attribute__((always_inline)) {
        const glm::dmat3& cones = m.exact_cones;
        return static_cast<float>(cones[0][row] * r + cones[1][row] * g + cones[2][row] * b);
    };
    return lab_of_cones(m.oklab, Vector(cone(0), cone(1), cone(2)));
}

template <typename Planes>
LIVERY_ALWAYS_INLINE Gamut gamut_at(const Planes& rows, std::size_t i) {
    return {{rows[0][i], rows[1][i], rows[2][i]},
            {rows[3][i], rows[4][i], rows[5][i]},
            {rows[6][i], rows[7][i], rows[8][i]},
            {rows[9][i], rows[10][i], rows[11][i]}};
}

/// Whether a non-additive projector can show it, within the cube.
bool in_table(const NonAdditive& table, Vector n) {
    glm::vec3 residual;
    drive_of_n(table, {n.x, n.y, n.z}, &residual);
    return glm::dot(residual, residual) <= kReachableN * kReachableN;
}

/// Those of a block that are usable and lie beyond a knee or outside their own gamut.
LIVERY_ALWAYS_INLINE std::size_t find_beyond(const Job& job,
                                             const GamutJob& gamut,
                                             const Wanted& wanted,
                                             std::uint32_t* __restrict list) {
    const Oklab& m = matrices().oklab;
    alignas(64) std::array<std::uint8_t, kBlock> beyond;
    std::uint8_t* __restrict flag = beyond.data();
    const std::array<const float*, 12> outer = gamut.boundary, own = job.coefficients;
    const float* __restrict darkest = gamut.darkest;
    const float* __restrict brightest = gamut.brightest;
    const float* __restrict r = wanted.r.data();
    const float* __restrict g = wanted.g.data();
    const float* __restrict b = wanted.b.data();
    const float* __restrict coverage = wanted.coverage.data();
    for (std::size_t i = 0; i < job.count; ++i) {
        const Vector colour(r[i], g[i], b[i]);
        const float sum = colour.x + colour.y + colour.z;
        // Where no neutral can be shown there is nothing to aim at: it is clipped and counted.
        const bool usable = (sum - sum == 0.0f) & (coverage[i] >= 0.5f) & (brightest[i] > 0.0f);
        const Vector lab = lab_of(m, colour);
        const bool inside = is_lit(lab.x, darkest[i], brightest[i]) &
                            in_cube(n_of(gamut_at(outer, i), stretched(m, lab))) &
                            in_cube(n_of(gamut_at(own, i), colour));
        flag[i] = static_cast<std::uint8_t>(usable & !inside);
    }
    std::size_t found = 0;
    for (std::size_t i = 0; i < job.count; ++i) {
        if (gamut.table && flag[i] == 0 && coverage[i] >= 0.5f && brightest[i] > 0.0f) {
            const Vector colour(r[i], g[i], b[i]);
            const Vector far = stretched(m, lab_of(m, colour));
            const float sum = colour.x + colour.y + colour.z;
            flag[i] = static_cast<std::uint8_t>(
                sum - sum == 0.0f && !(in_table(*gamut.table, n_of(gamut_at(outer, i), far)) &&
                                       in_table(*gamut.table, n_of(gamut_at(own, i), colour))));
        }
        list[found] = static_cast<std::uint32_t>(i);
        found += flag[i];
    }
    return found;
}

struct Moving {
    Matrices m;  ///< a copy, which no store of the loops can change
    const NonAdditive* table;
    std::size_t count;
};

/// Whether the colour with `scale` times the chroma of `lab` is inside.
template <bool kTable>
LIVERY_ALWAYS_INLINE bool contains(
    const Moving& moving, const Gamuts& gamuts, const Colours& lab, std::size_t i, float scale) {
    const Vector colour = with_chroma({lab.x[i], lab.y[i], lab.z[i]}, scale);
    const Vector n = n_of(gamut_at(gamuts.rows, i), rgb_of_lab(moving.m.oklab, colour));
    if constexpr (kTable) {
        return in_cube(n) && in_table(*moving.table, n);
    } else {
        return in_cube(n);
    }
}

/// Largest fraction in [0, 1] of the way from the neutral to `lab` that is inside.
template <bool kTable>
LIVERY_ALWAYS_INLINE void reach(const Moving& moving,
                                const Gamuts& gamuts,
                                const Colours& lab,
                                float* __restrict low) {
    float step = 0.5f;
    for (std::size_t i = 0; i < moving.count; ++i) low[i] = 0.0f;
    for (int halving = 0; halving < kHalvings; ++halving, step *= 0.5f) {
        LIVERY_INDEPENDENT
        for (std::size_t i = 0; i < moving.count; ++i) {
            const float middle = low[i] + step;
            low[i] = contains<kTable>(moving, gamuts, lab, i, middle) ? middle : low[i];
        }
    }
}

/// The neighbourhood's knees: lightness only where no neutral of it can be shown, then chroma at
/// that lightness and hue.
template <bool kTable>
LIVERY_ALWAYS_INLINE void bend_inwards(const Moving& moving,
                                       const Gamuts& outer,
                                       const float* __restrict darkest,
                                       const float* __restrict brightest,
                                       Colours* __restrict lab,
                                       Colours* __restrict rgb) {
    alignas(64) Row boundary;
    alignas(64) std::int32_t same[kMost];
    LIVERY_INDEPENDENT
    for (std::size_t i = 0; i < moving.count; ++i) {
        const Vector c = exact_lab_of(moving.m, {rgb->x[i], rgb->y[i], rgb->z[i]});
        lab->x[i] = bent_lightness(c.x, darkest[i], brightest[i]);
        lab->y[i] = c.y * kStretch;
        lab->z[i] = c.z * kStretch;
        same[i] = lab->x[i] == c.x ? 1 : 0;
    }
    reach<kTable>(moving, outer, *lab, boundary);
    LIVERY_INDEPENDENT
    for (std::size_t i = 0; i < moving.count; ++i) {
        const bool inside = contains<kTable>(moving, outer, *lab, i, 1.0f);
        const float scale = chroma_scale(boundary[i], inside);
        lab->y[i] *= scale;
        lab->z[i] *= scale;
        const Vector moved = rgb_of_lab(moving.m.oklab, {lab->x[i], lab->y[i], lab->z[i]});
        const bool as_it_is = (same[i] != 0) & inside;
        rgb->x[i] = as_it_is ? rgb->x[i] : moved.x;
        rgb->y[i] = as_it_is ? rgb->y[i] : moved.y;
        rgb->z[i] = as_it_is ? rgb->z[i] : moved.z;
    }
}

/// The pixel's own gamut has the last word.
template <bool kTable>
LIVERY_ALWAYS_INLINE void keep_inside(const Moving& moving,
                                      const Gamuts& own,
                                      const float* __restrict darkest,
                                      const float* __restrict brightest,
                                      Colours* __restrict lab,
                                      Colours* __restrict rgb) {
    alignas(64) std::int32_t as_it_is[kMost];
    std::int32_t left = 0;
    for (std::size_t i = 0; i < moving.count; ++i) {
        const bool inside = contains<kTable>(moving, own, *lab, i, 1.0f);
        as_it_is[i] = inside | !(brightest[i] > 0.0f) ? 1 : 0;
        left += 1 - as_it_is[i];
    }
    if (left == 0) return;
    for (std::size_t i = 0; i < moving.count; ++i) {
        lab->x[i] = own_lightness(lab->x[i], darkest[i], brightest[i]);
    }
    alignas(64) Row kept;
    reach<kTable>(moving, own, *lab, kept);
    LIVERY_INDEPENDENT
    for (std::size_t i = 0; i < moving.count; ++i) {
        const Vector moved =
            rgb_of_lab(moving.m.oklab, with_chroma({lab->x[i], lab->y[i], lab->z[i]}, kept[i]));
        rgb->x[i] = as_it_is[i] != 0 ? rgb->x[i] : moved.x;
        rgb->y[i] = as_it_is[i] != 0 ? rgb->y[i] : moved.y;
        rgb->z[i] = as_it_is[i] != 0 ? rgb->z[i] : moved.z;
    }
}

template <bool kTable>
LIVERY_ALWAYS_INLINE bool map_body(const Job& job, const GamutJob& gamut, Wanted* wanted) {
    alignas(64) std::array<std::uint32_t, kBlock + 1> list;
    const std::size_t found = find_beyond(job, gamut, *wanted, list.data());
    for (std::size_t begin = 0; begin < found; begin += kMost) {
        const std::uint32_t* const at = list.data() + begin;
        const Moving moving{matrices(), gamut.table, std::min(kMost, found - begin)};
        const std::size_t count = moving.count;
        const auto take = [at, count](const float* from, float* to) {
            for (std::size_t i = 0; i < count; ++i) to[i] = from[at[i]];
        };
        Gamuts outer, own;
        for (std::size_t plane = 0; plane < 12; ++plane) {
            take(gamut.boundary[plane], outer.rows[plane]);
            take(job.coefficients[plane], own.rows[plane]);
        }
        alignas(64) Row darkest, brightest, own_darkest, own_brightest;
        take(gamut.darkest, darkest);
        take(gamut.brightest, brightest);
        take(gamut.own_darkest, own_darkest);
        take(gamut.own_brightest, own_brightest);
        Colours rgb, lab;
        take(wanted->r.data(), rgb.x);
        take(wanted->g.data(), rgb.y);
        take(wanted->b.data(), rgb.z);
        bend_inwards<kTable>(moving, outer, darkest, brightest, &lab, &rgb);
        keep_inside<kTable>(moving, own, own_darkest, own_brightest, &lab, &rgb);
        for (std::size_t i = 0; i < count; ++i) {
            wanted->r[at[i]] = rgb.x[i];
            wanted->g[at[i]] = rgb.y[i];
            wanted->b[at[i]] = rgb.z[i];
        }
    }
    return found > 0;
}

}  // namespace

bool map_gamut_baseline(const Job& job, const GamutJob& gamut, Wanted* wanted) {
    return gamut.table ? map_body<true>(job, gamut, wanted) : map_body<false>(job, gamut, wanted);
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) bool map_gamut_avx2(const Job& job,
                                                    const GamutJob& gamut,
                                                    Wanted* wanted) {
    return gamut.table ? map_body<true>(job, gamut, wanted) : map_body<false>(job, gamut, wanted);
}
#endif

}  // namespace livery::kernel
