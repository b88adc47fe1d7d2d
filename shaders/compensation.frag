#version 450 core
// Equation 9 at every pixel: N = A * wanted + b, then each channel's response turned round.
// src/compensation/compensate.cpp is the oracle; the order of additions is the same.

#define MUTATED(name, x) (x)  // src/core/mutation.h

layout(binding = 0) uniform sampler2D wanted_working;  // R, G, B, coverage
layout(binding = 1) uniform sampler2D row_red;         // a row of A, and b
layout(binding = 2) uniform sampler2D row_green;
layout(binding = 3) uniform sampler2D row_blue;
layout(binding = 4) uniform sampler2D rho;             // drive, one row a channel

uniform int last_of_rho[3];
uniform uint dither_per_column;
uniform uint dither_per_row;

out vec4 drive;

float look_up(int channel, float n) {
    int last = last_of_rho[channel];
    float at = clamp(n, 0.0, 1.0) * float(last);
    int cell = min(int(at), last - 1);
    float low = texelFetch(rho, ivec2(cell, channel), 0).r;
    float high = texelFetch(rho, ivec2(cell + 1, channel), 0).r;
    return MUTATED(compensation_pass_drive, low + (at - float(cell)) * (high - low));
}

#ifdef NON_ADDITIVE
layout(binding = 5) uniform sampler2D nodes;      // N, (red + grid * green, blue)
layout(binding = 6) uniform sampler2D start;      // node number, the same layout
layout(binding = 7) uniform sampler2D linear_of;  // rho^-1 at the nodes, one row a channel

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

vec3 drive_of(vec3 n) {
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
    vec3 error = n_at_linear(grid, linear, jacobian) - n;
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
#else
vec3 drive_of(vec3 n) {
    return vec3(look_up(0, n.r), look_up(1, n.g), look_up(2, n.b));
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 wanted = texelFetch(wanted_working, pixel, 0);
    vec4 r = texelFetch(row_red, pixel, 0);
    vec4 g = texelFetch(row_green, pixel, 0);
    vec4 b = texelFetch(row_blue, pixel, 0);
    vec3 n = vec3(r.x, g.x, b.x) * wanted.r + vec3(r.y, g.y, b.y) * wanted.g +
             vec3(r.z, g.z, b.z) * wanted.b + MUTATED(compensation_pass_black, vec3(r.w, g.w, b.w));
    float sum = n.r + n.g + n.b;
    // A pixel without a calibration has zeros for A; no valid one has.
    bool usable = r.xyz != vec3(0.0) && wanted.a >= 0.5 && !isnan(sum) && !isinf(sum);
    if (!usable) {
        drive = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    uint phase = uint(pixel.x) * dither_per_column + uint(pixel.y) * dither_per_row;
    float threshold = float(phase >> 8u) * (1.0 / 16777216.0);
    drive = vec4(min(floor(drive_of(n) + threshold), vec3(255.0)) / 255.0, 1.0);
}
