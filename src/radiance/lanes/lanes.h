// Several floats at once (LIVERY_LANE_COUNT, eight unless a unit says four), with the names that
// the shared reflectance source uses. For the units of several instruction sets only: each compiles
// it for one, into a namespace of its own, and includes no header whose inline functions the rest
// of the program shares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#define LIVERY_LANE_FUNCTION inline __attribute__((always_inline))

namespace livery::LIVERY_LANES {

#ifndef LIVERY_LANE_COUNT
#define LIVERY_LANE_COUNT 8
#endif
inline constexpr std::size_t kLanes = LIVERY_LANE_COUNT;

using Lanes = float __attribute__((vector_size(4 * kLanes)));
using LaneWords = std::int32_t __attribute__((vector_size(4 * kLanes)));
using LaneBits = std::uint32_t __attribute__((vector_size(4 * kLanes)));
using LaneHalves = std::uint16_t __attribute__((vector_size(2 * kLanes)));

LIVERY_LANE_FUNCTION Lanes lanes_of(float value) { return Lanes{} + value; }

LIVERY_LANE_FUNCTION Lanes load(const float* from) {
    Lanes value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

/// Half floats, not negative, and NaN. Small ones go through integers: a thread may flush
/// denormals.
LIVERY_LANE_FUNCTION Lanes load_halves(const std::uint16_t* from) {
#if defined(__F16C__) && LIVERY_LANE_COUNT == 8
    __m128i halves;
    std::memcpy(&halves, from, sizeof halves);
    return reinterpret_cast<Lanes>(_mm256_cvtph_ps(halves));
#else
    LaneHalves halves;
    std::memcpy(&halves, from, sizeof halves);
    const LaneWords words = __builtin_convertvector(halves, LaneWords);
    const LaneWords least_special = LaneWords{} + 0x7c00, none = {};
    const LaneWords special = words >= least_special ? LaneWords{} + (112 << 23) : none;
    const LaneWords bits = (words << 13) + (112 << 23) + special;
    Lanes normal;
    std::memcpy(&normal, &bits, sizeof normal);
    return words < 1024 ? __builtin_convertvector(words, Lanes) * 0x1p-24f : normal;
#endif
}

/// As in GLM and GLSL: what is no number stays none when it comes first.
LIVERY_LANE_FUNCTION Lanes min(Lanes a, Lanes b) { return b < a ? b : a; }
LIVERY_LANE_FUNCTION Lanes max(Lanes a, Lanes b) { return b > a ? b : a; }
LIVERY_LANE_FUNCTION Lanes clamp(Lanes x, Lanes low, Lanes high) { return min(max(x, low), high); }
LIVERY_LANE_FUNCTION Lanes mix(Lanes a, Lanes b, Lanes t) { return a + t * (b - a); }

LIVERY_LANE_FUNCTION Lanes sqrt(Lanes x) {
#if defined(__AVX__) && LIVERY_LANE_COUNT == 8
    return reinterpret_cast<Lanes>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
#elif defined(__SSE2__) && LIVERY_LANE_COUNT == 4
    return reinterpret_cast<Lanes>(_mm_sqrt_ps(reinterpret_cast<__m128>(x)));
#else
    float values[kLanes];
    std::memcpy(values, &x, sizeof x);
    for (float& value : values) value = __builtin_sqrtf(value);
    return load(values);
#endif
}

/// 2^x to 2 ulp, for x in [-126, 126]; clamped there.
LIVERY_LANE_FUNCTION Lanes exp2(Lanes x) {
    x = clamp(x, lanes_of(-126.0f), lanes_of(126.0f));
    const Lanes whole = (x + 0x1.8p23f) - 0x1.8p23f;  // nearest integer
    const Lanes f = x - whole;
    // Taylor at 0 in f ln 2, |f| <= 1/2
    Lanes power = lanes_of(1.5403530e-4f);
    power = power * f + 1.3333558e-3f;
    power = power * f + 9.6181291e-3f;
    power = power * f + 5.5504109e-2f;
    power = power * f + 2.4022651e-1f;
    power = power * f + 6.9314718e-1f;
    power = power * f + 1.0f;
    const LaneWords exponent = (__builtin_convertvector(whole, LaneWords) + 127) << 23;
    Lanes scale;
    std::memcpy(&scale, &exponent, sizeof scale);
    return power * scale;
}

LIVERY_LANE_FUNCTION Lanes floor(Lanes x) {
    const Lanes nearest = (x + 0x1.8p23f) - 0x1.8p23f;
    return nearest > x ? nearest - 1.0f : nearest;
}

/// Cosine and sine to 1e-7, for x in [-pi, pi]: Taylor at 0 up to pi / 2, mirrored beyond.
LIVERY_LANE_FUNCTION Lanes cos(Lanes x) {
    const Lanes size = max(x, -x);
    const Lanes far = size > 1.57079633f ? lanes_of(1.0f) : lanes_of(0.0f);
    const Lanes y = size + far * (3.14159265f - 2.0f * size);
    const Lanes q = y * y;
    Lanes sum = lanes_of(2.0876757e-9f);
    sum = sum * q - 2.7557319e-7f;
    sum = sum * q + 2.4801587e-5f;
    sum = sum * q - 1.3888889e-3f;
    sum = sum * q + 4.1666667e-2f;
    sum = sum * q - 0.5f;
    sum = sum * q + 1.0f;
    return sum - 2.0f * far * sum;
}
LIVERY_LANE_FUNCTION Lanes sin(Lanes x) {
    const Lanes size = max(x, -x);
    const Lanes y = size > 1.57079633f ? 3.14159265f - size : size;
    const Lanes q = y * y;
    Lanes sum = lanes_of(1.6059044e-10f);
    sum = sum * q - 2.5052108e-8f;
    sum = sum * q + 2.7557319e-6f;
    sum = sum * q - 1.9841270e-4f;
    sum = sum * q + 8.3333333e-3f;
    sum = sum * q - 1.6666667e-1f;
    sum = (sum * q + 1.0f) * y;
    return x < 0.0f ? -sum : sum;
}

// Of shaders/radiance/glints.glsl.
LIVERY_LANE_FUNCTION LaneBits word_of(Lanes whole) {
    return reinterpret_cast<LaneBits>(__builtin_convertvector(whole, LaneWords));
}
LIVERY_LANE_FUNCTION Lanes unit_of(LaneBits word) {
    const auto upper = reinterpret_cast<LaneWords>(word >> 9u);
    return (__builtin_convertvector(upper, Lanes) + 0.5f) * 0x1p-23f;
}
LIVERY_LANE_FUNCTION Lanes octave_of(Lanes x) {
    return reinterpret_cast<Lanes>(reinterpret_cast<LaneBits>(x) & 0x7f800000u);
}

template <typename T>
struct Vector2 {
    T x, y;
};

template <typename T>
struct Vector3 {
    T x, y, z;
    Vector3() = default;
    LIVERY_LANE_FUNCTION explicit Vector3(T all) : x(all), y(all), z(all) {}
    LIVERY_LANE_FUNCTION Vector3(T its_x, T its_y, T its_z) : x(its_x), y(its_y), z(its_z) {}
};

template <typename T>
struct Vector4 {
    T x, y, z, w;
};

using Lanes2 = Vector2<Lanes>;
using Lanes3 = Vector3<Lanes>;
using Lanes4 = Vector4<Lanes>;

LIVERY_LANE_FUNCTION Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
LIVERY_LANE_FUNCTION Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
LIVERY_LANE_FUNCTION Lanes3 operator*(const Lanes3& a, const Lanes3& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
LIVERY_LANE_FUNCTION Lanes3 operator*(const Lanes3& a, Lanes b) {
    return {a.x * b, a.y * b, a.z * b};
}
LIVERY_LANE_FUNCTION Lanes3 operator*(Lanes a, const Lanes3& b) { return b * a; }
LIVERY_LANE_FUNCTION Lanes3 operator/(const Lanes3& a, const Lanes3& b) {
    return {a.x / b.x, a.y / b.y, a.z / b.z};
}
LIVERY_LANE_FUNCTION Lanes3& operator+=(Lanes3& a, const Lanes3& b) { return a = a + b; }
LIVERY_LANE_FUNCTION Lanes3& operator*=(Lanes3& a, const Lanes3& b) { return a = a * b; }

LIVERY_LANE_FUNCTION Lanes dot(const Lanes3& a, const Lanes3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
LIVERY_LANE_FUNCTION Lanes3 min(const Lanes3& a, const Lanes3& b) {
    return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
LIVERY_LANE_FUNCTION Lanes3 max(const Lanes3& a, const Lanes3& b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
LIVERY_LANE_FUNCTION Lanes3 sqrt(const Lanes3& a) { return {sqrt(a.x), sqrt(a.y), sqrt(a.z)}; }
LIVERY_LANE_FUNCTION Lanes3 mix(const Lanes3& a, const Lanes3& b, Lanes t) {
    return {mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t)};
}
LIVERY_LANE_FUNCTION Lanes3 exp2(const Lanes3& a) { return {exp2(a.x), exp2(a.y), exp2(a.z)}; }

}  // namespace livery::LIVERY_LANES
