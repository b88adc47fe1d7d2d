// The vertices of a cut sheet parted between its pieces: what walls are raised on.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "sheet.h"

namespace livery::assets {

/// A border edge of a piece, the piece on the left seen from outside.
struct PieceBorder {
    std::uint32_t from = 0, to = 0;  ///< posts
    int neighbour = kNoPanel;        ///< the piece across, kNoPanel at the sheet's end
    int region = 0;
};

/// One post for each vertex of each piece; where a piece touches itself in a point, one for each of
/// its fans there, so that walls around the fans share nothing.
struct Posts {
    std::vector<glm::uvec3> of_triangle;  ///< a triangle of the sheet -> posts of its corners
    std::vector<std::uint32_t> vertex;    ///< a post -> vertex of the sheet
    std::vector<int> piece;               ///< a post -> its piece
    std::vector<bool> on_centre;          ///< a post -> whether it has an edge on the plane z = 0
    std::vector<PieceBorder> borders;     ///< without those edges
};

/// `piece_of_triangle`: kNoPanel where the sheet has a hole.
Posts stand_posts(const Sheet& sheet, const std::vector<int>& piece_of_triangle);

}  // namespace livery::assets
