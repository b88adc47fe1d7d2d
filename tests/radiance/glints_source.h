// The source of glints (shaders/radiance/glints.glsl) as C++ in float and in double.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/mutation.h"

#define REAL Real
#define VEC2 Vec2
#define VEC3 Vec3
#define VEC4 Vec4
#define R(x) Real(x)
#define FN inline
#define INOUT(T) T&
#define WORD std::uint32_t
#define word_of(x) static_cast<std::uint32_t>(static_cast<std::int32_t>(x))
#define unit_of(w) ((Real((w) >> 9u) + Real(0.5)) * Real(0x1p-23))
#define octave_of(x) std::exp2(std::floor(std::log2(x)))

namespace livery::f32 {
using Real = float;
using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using glm::clamp, glm::floor, glm::max, glm::min, glm::sqrt;
#include "shaders/radiance/glints.glsl"
}  // namespace livery::f32

namespace livery::f64 {
using Real = double;
using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using glm::clamp, glm::floor, glm::max, glm::min, glm::sqrt;
#include "shaders/radiance/glints.glsl"
}  // namespace livery::f64

#undef REAL
#undef VEC2
#undef VEC3
#undef VEC4
#undef R
#undef FN
#undef INOUT
#undef WORD
#undef word_of
#undef unit_of
#undef octave_of
#undef GLINT_RADIUS2
#undef GLINT_LARGEST_VARIANCE
#undef GLINT_SMALLEST_CELL
#undef GLINT_LARGEST_CELL
