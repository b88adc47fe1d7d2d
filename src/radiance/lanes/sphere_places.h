// Where eight directions lie on a picture of the whole sphere, and what is there. For the units of
// several instruction sets only (lanes.h).
#pragma once

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

}  // namespace livery::LIVERY_LANES
