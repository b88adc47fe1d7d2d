// Photographs for people: a camera's own numbers are mostly green.
#pragma once

#include <glm/vec3.hpp>

#include "core/bench_ports.h"

namespace livery {

/// Gains of red, green and blue that make the bright part of a photograph of white neutral: a
/// camera's own numbers are mostly green. 1 where nothing is lit.
glm::dvec3 white_balance(const Photograph& white);

}  // namespace livery
