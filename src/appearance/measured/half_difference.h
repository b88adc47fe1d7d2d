// shaders/bsdf/half_difference.glsl as C++, in double and in float.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include "core/mutation.h"

#define REAL Real
#define VEC3 Vec3
#define R(x) Real(x)
#define FN inline

namespace livery::f32 {
using Real = float;
using Vec3 = glm::vec3;
using glm::atan, glm::clamp, glm::dot, glm::sqrt;
#include "shaders/bsdf/half_difference.glsl"
}  // namespace livery::f32

namespace livery::f64 {
using Real = double;
using Vec3 = glm::dvec3;
using glm::atan, glm::clamp, glm::dot, glm::sqrt;
#include "shaders/bsdf/half_difference.glsl"
}  // namespace livery::f64

#undef REAL
#undef VEC3
#undef R
#undef FN
