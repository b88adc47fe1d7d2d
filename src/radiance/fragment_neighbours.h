// Neighbours that share out the rays of their surface: each fragment traces an eighth of the
// directions and learns the others from those beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "radiance/surface_map.h"

namespace livery {

/// Every block of 4 x 2 pixels has one fragment of each turn.
inline constexpr std::size_t kNeighbourTurns = 8;
std::size_t neighbour_turn(const SurfaceMap& map, std::size_t fragment);

/// Finds, around a fragment, those that continue its surface.
class FragmentNeighbours {
  public:
    explicit FragmentNeighbours(const SurfaceMap& map);

    struct Neighbour {
        std::size_t fragment = 0;
        std::size_t turn = 0;
        float weight = 0.0f;  ///< falls off with distance
    };
    /// The fragment itself and those up to two pixels away: of its part, in its tangent plane.
    void around(std::size_t fragment, std::vector<Neighbour>& found) const;

  private:
    const SurfaceMap& map_;
    std::vector<std::uint32_t> first_;   ///< of each pixel among sorted_, and one more
    std::vector<std::uint32_t> sorted_;  ///< fragments by pixel
};

}  // namespace livery
