// A board in a photograph: a chessboard, or a ChArUco board, whose white squares hold markers, so
// that each corner is known by itself.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "calibration/geometry/board.h"
#include "core/image.h"

namespace livery {

/// A photograph of one channel, any scale, in 8 bits between its black and its bright end, by a
/// square root: squares in the dark stay apart.
Image8 grey_for_corners(const ImageF& picture);

/// A chessboard's `columns` x `rows` inner corners, row by row, to a fraction of a pixel (centres
/// at halves); empty where there is no such board. Which of its ends is the first cannot be told
/// from a board that looks the same turned round, and need not be: a turned board is a pose like
/// another. Throws FileError where the module that links OpenCV is missing, std::invalid_argument
/// for fewer than 3 x 3 corners. So do the others.
std::vector<glm::dvec2> find_board(const Image8& grey, int columns, int rows);

/// Columns and rows of the largest grid of 3 x 3 corners or more, whatever board it is of (which
/// is which depends on how it lies).
std::optional<glm::ivec2> find_any_grid(const Image8& grey);

/// The corners where the gradients around each meet, within `reach_px` of where they are given.
std::vector<glm::dvec2> refined_corners(const Image8& grey,
                                        std::span<const glm::dvec2> corners,
                                        int reach_px);

/// How wide the edges of a chessboard that was found are on average, 10% to 90%, pixels.
double edge_width_px(const Image8& grey,
                     int columns,
                     int rows,
                     std::span<const glm::dvec2> corners);

/// Dark quadrilaterals on brighter ground, clockwise, four corners each: what markers look like.
std::vector<glm::dvec2> find_quadrilaterals(const Image8& grey);

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
