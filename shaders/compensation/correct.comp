#version 450 core
// Equation 9 at every pixel of the table: N = A * wanted + b, then each channel's response turned
// round. src/compensation/compensate.cpp is the oracle; the order of additions is the same, and
// `precise` keeps it. Definitions: NON_ADDITIVE, GAMUT_MAPPING.
layout(local_size_x = GROUP) in;

#define MUTATED(name, x) (x)  // src/core/mutation.h

layout(binding = 0) uniform sampler2D wanted_working;  // R, G, B, coverage
layout(binding = 1) uniform sampler2D rho;             // drive, one row a channel
layout(binding = 0, rgba8) writeonly uniform image2D drive_picture;

// As in CompensationTable: planes of pixel_count values.
layout(std430, binding = 0) readonly buffer Pixels { uint pixels[]; };
layout(std430, binding = 1) readonly buffer Coefficients { float coefficients[]; };
layout(std430, binding = 3) buffer Counts { uint finite_count, high_count, low_count, out_count; };

uniform uint pixel_count;
uniform int last_of_rho[3];
uniform uint dither_per_column;
uniform uint dither_per_row;

#define REAL float
#define VEC3 vec3
#define R(x) x
#define FN
#define IN(T) T
#define AND &&
#define PRECISE precise
#define FLOAT_BITS(x) floatBitsToInt(x)
#define BITS_FLOAT(x) intBitsToFloat(x)
#include "compensation/gamut.glsl"

float look_up(int channel, float n) {
    int last = last_of_rho[channel];
    float at = clamp(n, 0.0, 1.0) * float(last);
    int cell = min(int(at), last - 1);
    float low = texelFetch(rho, ivec2(cell, channel), 0).r;
    float high = texelFetch(rho, ivec2(cell + 1, channel), 0).r;
    precise float here = low + (at - float(cell)) * (high - low);
    return MUTATED(compensation_pass_drive, here);
}

#ifdef NON_ADDITIVE
layout(binding = 2) uniform sampler2D nodes;      // N, (red + grid * green, blue)
layout(binding = 3) uniform sampler2D start;      // node number, the same layout
layout(binding = 4) uniform sampler2D linear_of;  // rho^-1 at the nodes, one row a channel

struct Tetrahedron {
    ivec3 corner;
    ivec3 first;   // the axis of the largest fraction
    ivec3 second;
    ivec3 third;
    vec3 fraction;  // from the largest to the smallest
};

Tetrahedron tetrahedron_at(int grid, vec3 position) {
    Tetrahedron t;
    t.corner = clamp(ivec3(position), ivec3(0), ivec3(grid - 2));
    vec3 f = position - vec3(t.corner);
    t.first = ivec3(1, 0, 0);
    t.second = ivec3(0, 1, 0);
    t.third = ivec3(0, 0, 1);
    ivec3 swapped;
    if (f.x < f.y) { swapped = t.first; t.first = t.second; t.second = swapped; f.xy = f.yx; }
    if (f.y < f.z) { swapped = t.second; t.second = t.third; t.third = swapped; f.yz = f.zy; }
    if (f.x < f.y) { swapped = t.first; t.first = t.second; t.second = swapped; f.xy = f.yx; }
    t.fraction = f;
    return t;
}

vec3 node_of(sampler2D grid_values, int grid, ivec3 node) {
    return texelFetch(grid_values, ivec2(node.x + grid * node.y, node.z), 0).rgb;
}

/// Also how the value changes from node to node along each axis.
vec3 interpolate(sampler2D values, int grid, vec3 position, out mat3 change) {
    Tetrahedron t = tetrahedron_at(grid, position);
    vec3 v0 = node_of(values, grid, t.corner);
    vec3 v1 = node_of(values, grid, t.corner + t.first);
    vec3 v2 = node_of(values, grid, t.corner + t.first + t.second);
    vec3 v3 = node_of(values, grid, t.corner + ivec3(1));
    vec3 d0 = v1 - v0, d1 = v2 - v1, d2 = v3 - v2;
    vec3 e0 = vec3(t.first), e1 = vec3(t.second), e2 = vec3(t.third);
    change = mat3(d0 * e0.x + d1 * e1.x + d2 * e2.x,
                  d0 * e0.y + d1 * e1.y + d2 * e2.y,
                  d0 * e0.z + d1 * e1.z + d2 * e2.z);
    vec3 f = t.fraction;
    return v0 * (1.0 - f.x) + v1 * (f.x - f.y) + v2 * (f.y - f.z) + v3 * f.z;
}

vec3 rho_of(vec3 linear) {
    return vec3(look_up(0, linear.r), look_up(1, linear.g), look_up(2, linear.b));
}

vec3 n_at_linear(int grid, vec3 linear, out mat3 jacobian) {
    vec3 drive = rho_of(linear);
    vec3 node, per_node;
    for (int k = 0; k < 3; ++k) {
        int cell = clamp(int(drive[k] * float(grid - 1) * (1.0 / 255.0)), 0, grid - 2);
        float low = texelFetch(linear_of, ivec2(cell, k), 0).r;
        per_node[k] = 1.0 / (texelFetch(linear_of, ivec2(cell + 1, k), 0).r - low);
        node[k] = float(cell) + clamp((linear[k] - low) * per_node[k], 0.0, 1.0);
    }
    vec3 n = interpolate(nodes, grid, node, jacobian);
    for (int k = 0; k < 3; ++k) jacobian[k] *= per_node[k];
    return n;
}

/// `error`: its N less the wanted one.
vec3 drive_of(vec3 n, out vec3 error) {
    int grid = textureSize(nodes, 0).y;
    int start_grid = textureSize(start, 0).y;
    mat3 jacobian, jacobian_there;
    vec3 in_start = rho_of(n) * (1.0 / 255.0) * float(start_grid - 1);
    vec3 node = interpolate(start, start_grid, in_start, jacobian);
    vec3 linear;
    for (int k = 0; k < 3; ++k) {
        int cell = clamp(int(node[k]), 0, grid - 2);
        float low = texelFetch(linear_of, ivec2(cell, k), 0).r;
        float high = texelFetch(linear_of, ivec2(cell + 1, k), 0).r;
        linear[k] = low + (node[k] - float(cell)) * (high - low);
    }
    error = n_at_linear(grid, linear, jacobian) - n;
    for (int step = 0; step < NEWTON_STEPS; ++step) {
        if (dot(error, error) < SOLVED_N * SOLVED_N || abs(determinant(jacobian)) < 1e-18) break;
        vec3 tried = clamp(linear - inverse(jacobian) * error, vec3(0.0), vec3(1.0));
        vec3 error_there = n_at_linear(grid, tried, jacobian_there) - n;
        if (dot(error_there, error_there) >= dot(error, error)) break;
        linear = tried;
        error = error_there;
        jacobian = jacobian_there;
    }
    return rho_of(linear);
}

// Beyond what is reachable, one bit each; by what is left of N.
uint clipping_of(vec3 n, vec3 error) {
    bool high = min(error.r, min(error.g, error.b)) < -REACHABLE_N;
    bool low = max(error.r, max(error.g, error.b)) > REACHABLE_N;
    return (high ? 1u : 0u) | (low ? 2u : 0u);
}

bool is_shown(vec3 n) {
    vec3 error;
    if (!in_cube(n)) return false;
    drive_of(n, error);
    return dot(error, error) <= REACHABLE_N * REACHABLE_N;
}
#else
vec3 drive_of(vec3 n, out vec3 error) {
    error = vec3(0.0);
    return vec3(look_up(0, n.r), look_up(1, n.g), look_up(2, n.b));
}

uint clipping_of(vec3 n, vec3 error) {
    bool high = any(greaterThan(n, vec3(1.0 + GAMUT_TOLERANCE)));
    bool low = any(lessThan(n, vec3(-GAMUT_TOLERANCE)));
    return (high ? 1u : 0u) | (low ? 2u : 0u);
}

bool is_shown(vec3 n) { return in_cube(n); }
#endif

bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

Gamut own_gamut(uint i) {
    float c[12];
    for (uint plane = 0u; plane < 12u; ++plane) c[plane] = coefficients[plane * pixel_count + i];
    return Gamut(vec3(c[0], c[1], c[2]),
                 vec3(c[3], c[4], c[5]),
                 vec3(c[6], c[7], c[8]),
                 MUTATED(compensation_pass_black, vec3(c[9], c[10], c[11])));
}

#ifdef GAMUT_MAPPING
// GamutBoundary's planes: 12 of coefficients, then darkest, brightest, the pixel's own two.
layout(std430, binding = 2) readonly buffer Boundary { float boundary[]; };

float boundary_plane(uint plane, uint i) { return boundary[plane * pixel_count + i]; }

Gamut outer_gamut(uint i) {
    float c[12];
    for (uint plane = 0u; plane < 12u; ++plane) c[plane] = boundary_plane(plane, i);
    return Gamut(vec3(c[0], c[1], c[2]),
                 vec3(c[3], c[4], c[5]),
                 vec3(c[6], c[7], c[8]),
                 vec3(c[9], c[10], c[11]));
}

const Oklab oklab = Oklab(OKLAB_CONES, OKLAB_LAB, OKLAB_ROOTS, OKLAB_RGB);
const dmat3 exact_cones = EXACT_CONES;  // its columns are the rows

bool contains(Gamut gamut, vec3 lab, float scale) {
    return is_shown(n_of(gamut, rgb_of_lab(oklab, with_chroma(lab, scale))));
}

/// Largest fraction in [0, 1] of the way from the neutral to `lab` that is inside.
float reach(Gamut gamut, vec3 lab) {
    float low = 0.0, part = 0.5;
    for (int halving = 0; halving < kHalvings; ++halving, part *= 0.5) {
        if (contains(gamut, lab, low + part)) low += part;
    }
    return low;
}

/// What the pixel shows instead of `rgb`; the same where it is well inside.
vec3 mapped(vec3 rgb, uint i, Gamut own) {
    float darkest = boundary_plane(12u, i), brightest = boundary_plane(13u, i);
    // Where no neutral can be shown there is nothing to aim at: it is clipped and counted.
    if (!is_finite(rgb.r + rgb.g + rgb.b) || !(brightest > 0.0)) return rgb;
    Gamut outer = outer_gamut(i);
    vec3 lab = lab_of_cones(oklab, times(oklab.cones, rgb));
    if (is_lit(lab.x, darkest, brightest) && is_shown(n_of(outer, stretched(oklab, lab))) &&
        is_shown(n_of(own, rgb))) {
        return rgb;
    }
    vec3 wanted = lab_of_cones(oklab, vec3(dvec3(rgb) * exact_cones));
    lab = with_chroma(wanted, kStretch);
    lab.x = bent_lightness(wanted.x, darkest, brightest);
    float boundary_here = reach(outer, lab);
    bool inside = contains(outer, lab, 1.0);
    float scale = chroma_scale(boundary_here, inside);
    vec3 moved = lab.x == wanted.x && inside ? rgb
                                             : rgb_of_lab(oklab, with_chroma(lab, scale));
    lab = with_chroma(lab, scale);
    // The pixel's own gamut has the last word.
    float own_darkest = boundary_plane(14u, i), own_brightest = boundary_plane(15u, i);
    if (!(own_brightest > 0.0) || contains(own, lab, 1.0)) return moved;
    lab.x = own_lightness(lab.x, own_darkest, own_brightest);
    return rgb_of_lab(oklab, with_chroma(lab, reach(own, lab)));
}
#endif

shared uint finite_and_high, low_and_out;  // of the group, 16 bits each

/// The drive, 0 to 1; black where `n` is no colour.
vec3 levels_of(vec3 n, ivec2 pixel, out uint clipping) {
    clipping = 0u;
    if (!is_finite(n.r + n.g + n.b)) return vec3(0.0);
    vec3 error;
    vec3 drive = drive_of(n, error);
    clipping = clipping_of(n, error);
    uint phase = uint(pixel.x) * dither_per_column + uint(pixel.y) * dither_per_row;
    float threshold = float(phase >> 8u) * (1.0 / 16777216.0);
    return min(floor(drive + threshold), vec3(255.0)) / 255.0;
}

void correct(uint i) {
    ivec2 pixel = ivec2(int(pixels[i]) % textureSize(wanted_working, 0).x,
                        int(pixels[i]) / textureSize(wanted_working, 0).x);
    vec4 wanted = texelFetch(wanted_working, pixel, 0);
    vec3 levels = vec3(0.0);
    if (wanted.a >= 0.5) {
        Gamut own = own_gamut(i);
        vec3 n = n_of(own, wanted.rgb);
        uint clipping;
        levels = levels_of(n, pixel, clipping);
        bool high = (clipping & 1u) != 0u, low = (clipping & 2u) != 0u;
        if (is_finite(n.r + n.g + n.b)) atomicAdd(finite_and_high, high ? 0x10001u : 1u);
        if (clipping != 0u) atomicAdd(low_and_out, low ? 0x10001u : 0x10000u);
#ifdef GAMUT_MAPPING
        // What is counted is what was wanted.
        vec3 moved = mapped(wanted.rgb, i, own);
        if (moved != wanted.rgb) {
            levels = levels_of(n_of(own, moved), pixel, clipping);
        }
#endif
    }
    imageStore(drive_picture, pixel, vec4(levels, 1.0));
}

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        finite_and_high = 0u;
        low_and_out = 0u;
    }
    barrier();
    if (gl_GlobalInvocationID.x < pixel_count) correct(gl_GlobalInvocationID.x);
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    atomicAdd(finite_count, finite_and_high & 0xffffu);
    atomicAdd(high_count, finite_and_high >> 16u);
    atomicAdd(low_count, low_and_out & 0xffffu);
    atomicAdd(out_count, low_and_out >> 16u);
}
