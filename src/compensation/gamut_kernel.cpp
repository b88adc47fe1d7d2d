// Gamut mapping of a block of pixels. Most pixels of most pictures lie well inside: one loop finds
// those that do not, and only they are gathered and moved.
#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/glm.hpp>

#include "compensation/drive_table.h"
#include "compensation/kernel.h"
#include "core/colour.h"

#define LIVERY_ALWAYS_INLINE inline __attribute__((always_inline))
/// Of a loop over pixels: no pixel reads what another has written.
#define LIVERY_INDEPENDENT _Pragma("GCC ivdep")

namespace livery::kernel {
namespace {

constexpr float kChromaKnee = 0.85f;
/// Tighter: a wider one would grey the design white itself.
constexpr float kLightnessKnee = 0.95f;
constexpr int kHalvings = 18;
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

/// Rows of a matrix.
template <typename Real>
using Matrix = std::array<Real, 9>;

template <typename Real>
Matrix<Real> rows_of(const glm::dmat3& m) {
    Matrix<Real> rows;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            rows[static_cast<std::size_t>(3 * row + column)] = static_cast<Real>(m[column][row]);
        }
    }
    return rows;
}

struct OklabMatrices {
    Matrix<double> exact_cones = rows_of<double>(oklab_cones_from_xyz() * xyz_from_working());
    Matrix<float> cones = rows_of<float>(oklab_cones_from_xyz() * xyz_from_working());
    Matrix<float> lab = rows_of<float>(oklab_from_cone_roots());
    Matrix<float> roots = rows_of<float>(glm::inverse(oklab_from_cone_roots()));
    Matrix<float> rgb = rows_of<float>(glm::inverse(oklab_cones_from_xyz() * xyz_from_working()));
};

const OklabMatrices& matrices() {
    static const OklabMatrices all;
    return all;
}

template <typename Real>
LIVERY_ALWAYS_INLINE Real row_of(const Real* m, Real x, Real y, Real z) {
    return m[0] * x + m[1] * y + m[2] * z;
}

/// Cube root to the last bit or two: a guess from the exponent and two of Halley's steps.
LIVERY_ALWAYS_INLINE float root_of(float x) {
    const float size = x < 0.0f ? -x : x;
    const auto bits = static_cast<float>(std::bit_cast<std::int32_t>(size));
    float y = std::bit_cast<float>(static_cast<std::int32_t>(bits * (1.0f / 3.0f)) + 709982100);
    for (int step = 0; step < 2; ++step) {
        const float cube = y * y * y;
        y *= (cube + 2.0f * size) / (2.0f * cube + size);
    }
    y = size > 1e-30f ? y : 0.0f;
    return x < 0.0f ? -y : y;
}

struct Lab {
    float l, a, b;
};

/// Saturated colours leave next to nothing to one kind of cones, and its root makes much of what
/// floats round away: `cones` is a matrix of doubles for colours that are moved.
template <typename Real>
LIVERY_ALWAYS_INLINE Lab
lab_of(const OklabMatrices& m, const Matrix<Real>& cones, Real r, Real g, Real b) {
    const float x = root_of(static_cast<float>(row_of(&cones[0], r, g, b)));
    const float y = root_of(static_cast<float>(row_of(&cones[3], r, g, b)));
    const float z = root_of(static_cast<float>(row_of(&cones[6], r, g, b)));
    return {row_of(&m.lab[0], x, y, z), row_of(&m.lab[3], x, y, z), row_of(&m.lab[6], x, y, z)};
}

struct Rgb {
    float r, g, b;
};

LIVERY_ALWAYS_INLINE Rgb rgb_of(const OklabMatrices& m, float l, float a, float b) {
    const float x = row_of(&m.roots[0], l, a, b);
    const float y = row_of(&m.roots[3], l, a, b);
    const float z = row_of(&m.roots[6], l, a, b);
    const float xxx = x * x * x, yyy = y * y * y, zzz = z * z * z;
    return {row_of(&m.rgb[0], xxx, yyy, zzz),
            row_of(&m.rgb[3], xxx, yyy, zzz),
            row_of(&m.rgb[6], xxx, yyy, zzz)};
}

/// N of a channel.
template <typename Planes>
LIVERY_ALWAYS_INLINE float n_of(const Planes& rows, std::size_t channel, std::size_t i, Rgb c) {
    return rows[3 * channel][i] * c.r + rows[3 * channel + 1][i] * c.g +
           rows[3 * channel + 2][i] * c.b + rows[9 + channel][i];
}

LIVERY_ALWAYS_INLINE float least(float a, float b) { return a < b ? a : b; }
LIVERY_ALWAYS_INLINE float most(float a, float b) { return a > b ? a : b; }

template <typename Planes>
LIVERY_ALWAYS_INLINE bool in_cube(const Planes& rows, std::size_t i, Rgb c) {
    const float x = n_of(rows, 0, i, c), y = n_of(rows, 1, i, c), z = n_of(rows, 2, i, c);
    return (x >= 0.0f) & (x <= 1.0f) & (y >= 0.0f) & (y <= 1.0f) & (z >= 0.0f) & (z <= 1.0f);
}

/// Whether a non-additive projector can show it, within the cube.
template <typename Planes>
bool in_table(const NonAdditive& table, const Planes& rows, std::size_t i, Rgb c) {
    glm::vec3 residual;
    drive_of_n(table, {n_of(rows, 0, i, c), n_of(rows, 1, i, c), n_of(rows, 2, i, c)}, &residual);
    return glm::dot(residual, residual) <= kReachableN * kReachableN;
}

/// Those of a block that are usable and lie beyond a knee or outside their own gamut.
LIVERY_ALWAYS_INLINE std::size_t find_beyond(const Job& job,
                                             const GamutJob& gamut,
                                             const Wanted& wanted,
                                             std::uint32_t* __restrict list) {
    const OklabMatrices& m = matrices();
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
        const float sum = r[i] + g[i] + b[i];
        // Where no neutral can be shown there is nothing to aim at: it is clipped and counted.
        const bool usable = (sum - sum == 0.0f) & (coverage[i] >= 0.5f) & (brightest[i] > 0.0f);
        const Lab lab = lab_of(m, m.cones, r[i], g[i], b[i]);
        const float knee = darkest[i] * (1.0f / kChromaKnee);
        const bool lit = (lab.l >= knee) & (lab.l <= kLightnessKnee * brightest[i]);
        const Rgb stretched =
            rgb_of(m, lab.l, lab.a * (1.0f / kChromaKnee), lab.b * (1.0f / kChromaKnee));
        const bool inside =
            lit & in_cube(outer, i, stretched) & in_cube(own, i, Rgb{r[i], g[i], b[i]});
        flag[i] = static_cast<std::uint8_t>(usable & !inside);
    }
    std::size_t found = 0;
    for (std::size_t i = 0; i < job.count; ++i) {
        if (gamut.table && flag[i] == 0 && coverage[i] >= 0.5f && brightest[i] > 0.0f) {
            const Rgb colour{r[i], g[i], b[i]};
            const Lab lab = lab_of(m, m.cones, r[i], g[i], b[i]);
            const Rgb stretched =
                rgb_of(m, lab.l, lab.a * (1.0f / kChromaKnee), lab.b * (1.0f / kChromaKnee));
            const float sum = colour.r + colour.g + colour.b;
            flag[i] = static_cast<std::uint8_t>(sum - sum == 0.0f &&
                                                !(in_table(*gamut.table, outer, i, stretched) &&
                                                  in_table(*gamut.table, own, i, colour)));
        }
        list[found] = static_cast<std::uint32_t>(i);
        found += flag[i];
    }
    return found;
}

/// t / (1 + t^3)^(1/3): the identity near 0, towards 1; the least that is 1 to the last bit stands
/// for all beyond.
LIVERY_ALWAYS_INLINE float bend(float t) {
    const float x = least(t, 1e4f);
    return x / root_of(1.0f + x * x * x);
}

/// The identity up to `knee`, then bends towards 1 with slope 1 at the knee; rising everywhere.
LIVERY_ALWAYS_INLINE float soft(float x, float knee) {
    return x <= knee ? x : knee + (1.0f - knee) * bend((x - knee) * (1.0f / (1.0f - knee)));
}

struct Moving {
    OklabMatrices m;  ///< a copy, which no store of the loops can change
    const NonAdditive* table;
    std::size_t count;
};

/// Whether the colour with `scale` times the chroma of `lab` is inside.
template <bool kTable>
LIVERY_ALWAYS_INLINE bool contains(
    const Moving& moving, const Gamuts& gamuts, const Colours& lab, std::size_t i, float scale) {
    const Rgb c = rgb_of(moving.m, lab.x[i], lab.y[i] * scale, lab.z[i] * scale);
    const bool inside = in_cube(gamuts.rows, i, c);
    if constexpr (kTable) {
        return inside && in_table(*moving.table, gamuts.rows, i, c);
    } else {
        return inside;
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
    constexpr float kStretch = 1.0f / kChromaKnee;
    alignas(64) Row boundary;
    alignas(64) std::int32_t same[kMost];
    LIVERY_INDEPENDENT
    for (std::size_t i = 0; i < moving.count; ++i) {
        const Lab c =
            lab_of<double>(moving.m, moving.m.exact_cones, rgb->x[i], rgb->y[i], rgb->z[i]);
        const float floor = darkest[i], high = brightest[i];
        const float knee = least(floor * kStretch, high);
        const float room = most(knee - floor, 1e-12f);
        const float raised = knee - room * bend((knee - c.l) / room);
        const float l = (c.l >= knee) | (knee <= floor) ? c.l : raised;
        const float relative = l / high;
        const float bent = high * soft(relative, kLightnessKnee);
        lab->x[i] = relative <= kLightnessKnee ? l : bent;
        lab->y[i] = c.a * kStretch;
        lab->z[i] = c.b * kStretch;
        same[i] = lab->x[i] == c.l ? 1 : 0;
    }
    reach<kTable>(moving, outer, *lab, boundary);
    LIVERY_INDEPENDENT
    for (std::size_t i = 0; i < moving.count; ++i) {
        const bool inside = contains<kTable>(moving, outer, *lab, i, 1.0f);
        const float far = boundary[i] * kStretch;  // in units of the wanted chroma
        const float kept = far * soft(1.0f / most(far, 1e-6f), kChromaKnee);
        const float scale = kChromaKnee * (inside ? 1.0f : kept);
        lab->y[i] *= scale;
        lab->z[i] *= scale;
        const Rgb moved = rgb_of(moving.m, lab->x[i], lab->y[i], lab->z[i]);
        const bool as_it_is = (same[i] != 0) & inside;
        rgb->x[i] = as_it_is ? rgb->x[i] : moved.r;
        rgb->y[i] = as_it_is ? rgb->y[i] : moved.g;
        rgb->z[i] = as_it_is ? rgb->z[i] : moved.b;
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
        // A hair inside: Oklab's neutrals, by its rounded matrices, are D65 to about 1e-4 only.
        const float margin = 5e-4f * (brightest[i] - darkest[i]);
        lab->x[i] = most(least(lab->x[i], brightest[i] - margin), darkest[i] + margin);
    }
    alignas(64) Row kept;
    reach<kTable>(moving, own, *lab, kept);
    LIVERY_INDEPENDENT
    for (std::size_t i = 0; i < moving.count; ++i) {
        const Rgb moved = rgb_of(moving.m, lab->x[i], lab->y[i] * kept[i], lab->z[i] * kept[i]);
        rgb->x[i] = as_it_is[i] != 0 ? rgb->x[i] : moved.r;
        rgb->y[i] = as_it_is[i] != 0 ? rgb->y[i] : moved.g;
        rgb->z[i] = as_it_is[i] != 0 ? rgb->z[i] : moved.b;
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
