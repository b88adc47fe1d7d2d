// Rays of a view in square tiles: which tiles can see the mesh, and cheap rays inside one.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

inline constexpr int kTile_px = 16;

/// Tiles (in units of kTile_px, row by row) that some triangle may cover; conservative, also for
/// triangles that a lens bends.
std::vector<glm::ivec2> tiles_that_see(const Mesh& mesh, const View& view);

/// Directions through the pixels of one tile. Lens distortion is undone exactly at nine points
/// and interpolated quadratically between them: under 1e-3 px for lenses that invert at all.
class TileRays {
  public:
    TileRays(const View& view, glm::ivec2 tile);

    /// Unit direction in the world; nothing where the lens model reaches no direction.
    std::optional<glm::vec3> direction(glm::dvec2 pixel) const;

    /// Along one row of the tile, for many rays: as far as a view depth of 1, not unit.
    struct Row {
        glm::dvec3 start, slope, bend;
        glm::vec3 direction(double tiles_from_corner) const {
            return glm::vec3(start + tiles_from_corner * (slope + tiles_from_corner * bend));
        }
    };
    /// Nothing where direction() has to solve each ray by itself.
    std::optional<Row> row(double y_px) const;

  private:
    const View* view_;
    glm::dvec2 corner_px_;
    bool exact_ = false;              ///< a node has no direction: every ray is solved by itself
    std::array<glm::dvec3, 9> node_;  ///< world directions at view depth 1
};

}  // namespace livery
