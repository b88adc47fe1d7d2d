// The reflectance source of shaders/bsdf, as C++ twice: livery::f32 and livery::f64. The same lines
// run in the shaders.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/mutation.h"

#define REAL Real
#define VEC2 Vec2
#define VEC3 Vec3
#define R(x) Real(x)
#define FN inline
#define IN(T) const T&
#define OUT(T) T&
#define PRESENT(x) ((x) > Real(0))

// An unused parameter is normal here: all models share one signature.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"

namespace livery::f32 {
using Real = float;
using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using glm::abs, glm::acos, glm::atan, glm::clamp, glm::cos, glm::dot, glm::exp, glm::exp2,
    glm::floor, glm::log, glm::log2, glm::max, glm::min, glm::mix, glm::normalize, glm::pow,
    glm::sin, glm::sqrt;
#include "appearance/bsdf_files.inc"
}  // namespace livery::f32

namespace livery::f64 {
using Real = double;
using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using glm::abs, glm::acos, glm::atan, glm::clamp, glm::cos, glm::dot, glm::exp, glm::exp2,
    glm::floor, glm::log, glm::log2, glm::max, glm::min, glm::mix, glm::normalize, glm::pow,
    glm::sin, glm::sqrt;
#include "appearance/bsdf_files.inc"
}  // namespace livery::f64

#pragma GCC diagnostic pop

#undef LOBE_ALBEDO
#undef FILM_BAND
#undef BASE_LOBE
#undef COAT_LOBE
#undef FLAKE_LOBE
#undef REAL
#undef VEC2
#undef VEC3
#undef R
#undef FN
#undef IN
#undef OUT
#undef PRESENT
