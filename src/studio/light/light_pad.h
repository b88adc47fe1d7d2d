// A small map of the sky over the product, on which lights are pulled about.
#pragma once

#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/look.h"

namespace livery {

/// Draws the pad with a dot a light and a mark for the eye. Each dot is an item that changes its
/// light's direction while it is held, named "light-pad:0", ...; `after_dot` is called right after
/// it.
void light_pad(std::vector<DirectionalLight>& lights,
               const glm::dvec3& toward_eye,
               float side_px,
               const std::function<void()>& after_dot);

}  // namespace livery
