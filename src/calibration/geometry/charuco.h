// A ChArUco board in a photograph: a chessboard whose white squares hold markers, so that each
// corner is known by itself and part of the board will do.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "calibration/geometry/board.h"
#include "core/image.h"

namespace livery {

/// A marker that was read: its corners in the picture, the marker's upper left one first, clockwise
/// (centres at halves).
struct SeenMarker {
    int number = 0;
    std::vector<glm::dvec2> corners_px;
};

/// Markers numbered below `count` among quadrilaterals of dark borders (four corners each,
/// clockwise). What is no marker is left out; a number may come twice.
std::vector<SeenMarker> read_markers(const Image8& grey,
                                     std::span<const glm::dvec2> quadrilaterals_px,
                                     int count);

/// Inner corners of the board, row by row, to a fraction of a pixel (centres at halves): those
/// between two markers that were read and lie as the board has them (Garrido-Jurado et al.,
/// Automatic generation and detection of highly reliable fiducial markers, 2014). Empty where fewer
/// than three markers agree on where the board is. Throws FileError where the module that links
/// OpenCV is missing, std::invalid_argument for a board that is no ChArUco board.
std::vector<std::optional<glm::dvec2>> find_charuco(const Image8& grey, const Board& board);

}  // namespace livery
