// What fragments mirror by one look-up a lobe. For the units of several instruction sets only
// (lanes.h).
#pragma once

#include "radiance/lanes/mirror_sums.h"
#include "radiance/lanes/sphere_places.h"

namespace livery::LIVERY_LANES {
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
