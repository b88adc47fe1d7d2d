// A chessboard in a photograph.
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "core/image.h"

namespace livery {

/// Its `columns` x `rows` inner corners, row by row, to a fraction of a pixel (centres at halves);
/// empty where there is no such board. One channel, any scale. Which of its ends is the first
/// cannot be told from a board that looks the same turned round. Throws FileError where the
/// module that links OpenCV is missing, std::invalid_argument for fewer than 3 x 3 corners.
std::vector<glm::dvec2> find_board(const ImageF& picture, int columns, int rows);

}  // namespace livery
