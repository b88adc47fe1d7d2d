// Where eight directions lie on a picture of the whole sphere, and what fragments mirror by one
// look-up a lobe there. For the units of several instruction sets only (lanes.h).
#pragma once

#include "radiance/lanes/lane_functions.h"
#include "radiance/lanes/lanes.h"

namespace livery::LIVERY_LANES {

/// Of the quotients of numbers that are not negative; 0 of two zeros. A polynomial on [0, 1],
/// within 2e-6 rad.
LIVERY_LANE_FUNCTION Lanes first_quadrant_angle(Lanes y, Lanes x) {
    const Lanes larger = y > x ? y : x, smaller = y > x ? x : y;
    const Lanes t = smaller / max(larger, lanes_of(1e-30f));
    const Lanes t2 = t * t;
    Lanes p = lanes_of(-0.01172120f);
    p = p * t2 + 0.05265332f;
    p = p * t2 - 0.11643287f;
    p = p * t2 + 0.19354346f;
    p = p * t2 - 0.33262347f;
    p = p * t2 + 0.99997726f;
    const Lanes angle = p * t;
    return y > x ? 1.57079633f - angle : angle;
}

LIVERY_LANE_FUNCTION Lanes size_of(Lanes v) { return max(v, -v); }

/// As SpherePlaces (light/sphere_lookup.h).
LIVERY_LANE_FUNCTION Lanes2 place_of(const Lanes3& d, float turns) {
    Lanes azimuth = first_quadrant_angle(size_of(d.x), size_of(d.z));
    azimuth = d.z > 0.0f ? 3.14159265f - azimuth : azimuth;
    Lanes u = (d.x < 0.0f ? -azimuth : azimuth) * 0.159154943f + turns;
    u = u >= 1.0f ? u - 1.0f : u;
    u = u < 0.0f ? u + 1.0f : u;
    Lanes polar = first_quadrant_angle(sqrt(d.x * d.x + d.z * d.z), size_of(d.y));
    polar = d.y < 0.0f ? 3.14159265f - polar : polar;
    return {u, polar * 0.318309886f};
}

/// Where each lane looks a picture up: offsets of floats to four texels, and their weights.
struct Footprints {
    std::int32_t offset[4][kLanes];
    float weight[4][kLanes];
};

LIVERY_LANE_FUNCTION LaneWords whole_of(Lanes x) { return __builtin_convertvector(x, LaneWords); }

/// In pictures that begin at some row of so many floats a texel: bilinear, wrapped in azimuth.
LIVERY_LANE_FUNCTION void find_footprints(const Lanes2& uv,
                                          Lanes width,
                                          Lanes height,
                                          LaneWords first_row,
                                          int texel_floats,
                                          Footprints& to) {
    const LaneWords one = LaneWords{} + 1, none{};
    const Lanes x = uv.x * width - 0.5f, y = uv.y * height - 0.5f;
    // What is no number is read somewhere within, and stays none
    const auto below = [&](Lanes v) {
        return whole_of(v > -1.0f ? v + 1.0f : lanes_of(0.0f)) - one;
    };
    const LaneWords column = below(x), row = below(y);
    const Lanes fx = x - __builtin_convertvector(column, Lanes);
    const Lanes fy = y - __builtin_convertvector(row, Lanes);
    const LaneWords columns = whole_of(width), last = whole_of(height) - one;
    const auto clamped = [&](LaneWords r) {
        r = r < none ? none : r;
        return r > last ? last : r;
    };
    const LaneWords left = column < none ? column + columns : column;
    const LaneWords next = column + one;
    const LaneWords right = next >= columns ? next - columns : next;
    const LaneWords upper = (first_row + clamped(row)) * columns;
    const LaneWords lower = (first_row + clamped(row + one)) * columns;
    const auto keep = [&](std::size_t k, LaneWords at, Lanes weight) {
        const LaneWords offset = at * texel_floats;
        std::memcpy(to.offset[k], &offset, sizeof offset);
        std::memcpy(to.weight[k], &weight, sizeof weight);
    };
    const Lanes gx = 1.0f - fx, gy = 1.0f - fy;
    keep(0, upper + left, gx * gy);
    keep(1, upper + right, fx * gy);
    keep(2, lower + left, gx * fy);
    keep(3, lower + right, fx * fy);
}

using Four = float __attribute__((vector_size(16)));
LIVERY_LANE_FUNCTION Four four_at(const float* from) {
    Four value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

/// Two texels that lie side by side, of the k-th lane.
LIVERY_LANE_FUNCTION Lanes two_texels(const float* texels, const Footprints& at, std::size_t k) {
    return (at.weight[0][k] * load(texels + at.offset[0][k]) +
            at.weight[1][k] * load(texels + at.offset[1][k])) +
           (at.weight[2][k] * load(texels + at.offset[2][k]) +
            at.weight[3][k] * load(texels + at.offset[3][k]));
}

LIVERY_LANE_FUNCTION Four mixed(Lanes two, float share) {
    Four both[2];
    std::memcpy(both, &two, sizeof two);
    return (1.0f - share) * both[0] + share * both[1];
}

namespace {

#define REAL Lanes
#define VEC3 Lanes3
#define R(x) lanes_of(x##f)
#define FN LIVERY_LANE_FUNCTION
#include "shaders/bsdf/seen_from.glsl"
#undef REAL
#undef VEC3
#undef R
#undef FN

LIVERY_LANE_FUNCTION Lanes3 unit(const Lanes3& v) { return (1.0f / sqrt(dot(v, v))) * v; }

/// Of one lobe: the two pictures that each lane lies between, and where on them.
struct LobeLookUp {
    Footprints leaning;  ///< on the wide pictures, where the lobe leans
    LaneWords below;
    Lanes share;
    Lanes correction;
};

LIVERY_LANE_FUNCTION void aim_lobe(const MirrorLookUpJob& job,
                                   const MirrorLookUpJob::Lobe& lobe,
                                   Lanes widened,
                                   Lanes root,
                                   LobeLookUp& to) {
    // Squares double from picture to picture: the exponent is the picture, the mantissa the share.
    // The first has no width: in between, as the width is
    const Lanes ratio = (lobe.alpha2 + widened) * (1.0f / job.alpha2_of_first);
    const LaneWords bits = reinterpret_cast<LaneWords>(ratio);
    const LaneWords mantissa = (bits & 0x007fffff) | 0x3f800000;
    const LaneWords none{}, last = LaneWords{} + (job.sharp.count + job.wide.count - 2);
    const LaneWords octave = (bits >> 23) - 126;
    const LaneWords below = octave > none ? octave : none;
    const Lanes share = ratio < 1.0f ? sqrt(ratio) : reinterpret_cast<Lanes>(mantissa) - 1.0f;
    to.share = below > last ? lanes_of(1.0f) : share;
    to.share = ratio == ratio ? to.share : ratio;
    to.below = below > last ? last : below;

    constexpr int kIntervals = MirrorLookUpJob::kCorrections - 1;
    const Lanes at = root * static_cast<float>(kIntervals);
    const LaneWords last_interval = LaneWords{} + (kIntervals - 1);
    const LaneWords whole = whole_of(at);
    const LaneWords positive = whole > none ? whole : none;
    const LaneWords first = positive > last_interval ? last_interval : positive;
    Lanes low, high;
    for (std::size_t k = 0; k < kLanes; ++k) {
        low[k] = lobe.correction[first[k]];
        high[k] = lobe.correction[first[k] + 1];
    }
    to.correction = mix(low, high, at - __builtin_convertvector(first, Lanes));
}

/// Between two pictures at the k-th lane.
LIVERY_LANE_FUNCTION Four mirrored_by_lobe(const MirrorLookUpJob& job,
                                           const LobeLookUp& lobe,
                                           const Footprints& sharp,
                                           const Footprints& wide,
                                           std::size_t k) {
    const int below = lobe.below[k], in_wide = below - job.sharp.count;
    if (in_wide >= 0)
        return mixed(two_texels(job.wide.texels + 4 * in_wide, wide, k), lobe.share[k]);
    if (in_wide < -1)
        return mixed(two_texels(job.sharp.texels + 4 * below, sharp, k), lobe.share[k]);
    Four low{}, high{};
    for (int corner = 0; corner < 4; ++corner) {
        low += sharp.weight[corner][k] *
               four_at(job.sharp.texels + sharp.offset[corner][k] + 4 * below);
        high += wide.weight[corner][k] * four_at(job.wide.texels + wide.offset[corner][k]);
    }
    return (1.0f - lobe.share[k]) * low + lobe.share[k] * high;
}

void look_up_lobes(const MirrorLookUpJob& job) {
    const auto list = [&](std::size_t k) { return load(job.fragments + k * kLanes); };
    const Lanes3 normal{list(3), list(4), list(5)};
    const Lanes3 seen = unit({list(0), list(1), list(2)});
    const Lanes3 wo = seen_from(seen, normal);
    const Lanes cosine = clamp(dot(wo, normal), lanes_of(0.0f), lanes_of(1.0f));
    const Lanes3 mirrored = 2.0f * cosine * normal - wo;
    const Lanes2 uv = place_of(mirrored, job.turns);

    const auto find = [](const SphereTexels& in, const Lanes2& at, Footprints& to) {
        find_footprints(at,
                        lanes_of(static_cast<float>(in.width)),
                        lanes_of(static_cast<float>(in.height)),
                        LaneWords{},
                        4 * in.count,
                        to);
    };
    Footprints sharp, wide;
    find(job.sharp, uv, sharp);
    find(job.wide, uv, wide);
    const Lanes root = sqrt(cosine);
    LobeLookUp lobes[kMostLookUps];
    for (int i = 0; i < job.lobe_count; ++i) {
        const MirrorLookUpJob::Lobe& lobe = job.lobes[i];
        LobeLookUp& to = lobes[i];
        aim_lobe(job, lobe, list(6), root, to);
        if (lobe.leans) {
            const Lanes3 middle =
                unit(normal + lanes_of(lobe.toward_mirrored) * (mirrored - normal));
            find(job.wide, place_of(middle, job.turns), to.leaning);
        }
        // Far apart in memory, and read soon
        const Footprints& in_wide = lobe.leans ? to.leaning : wide;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const bool is_sharp = to.below[k] < job.sharp.count;
            const Footprints& at = is_sharp ? sharp : in_wide;
            const float* texels = is_sharp ? job.sharp.texels + 4 * to.below[k]
                                           : job.wide.texels + 4 * (to.below[k] - job.sharp.count);
            __builtin_prefetch(texels + at.offset[0][k]);
            __builtin_prefetch(texels + at.offset[2][k]);
        }
    }
    for (int i = 0; i < job.lobe_count; ++i) {
        const Footprints& in_wide = job.lobes[i].leans ? lobes[i].leaning : wide;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const Four light =
                lobes[i].correction[k] * mirrored_by_lobe(job, lobes[i], sharp, in_wide, k);
            std::memcpy(
                job.light + 4 * (kLanes * static_cast<std::size_t>(i) + k), &light, sizeof light);
        }
    }
}

}  // namespace
}  // namespace livery::LIVERY_LANES
