// Pictures to identify and test monitors with: large numbers as geometry, read from across a room
// with no font to look for.
#pragma once

#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"

namespace livery {

/// Width of a number of this height, without space around it.
double number_width_px(int number, double height_px);

/// Draws a non-negative number into a picture of three channels, with smooth edges.
void draw_number(
    Image8& picture, int number, glm::dvec2 centre_px, double height_px, const glm::u8vec3& colour);

}  // namespace livery
