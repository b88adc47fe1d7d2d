#include "radiance/ray_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"

namespace livery {
namespace {

struct Corner {
    glm::dvec3 world;
    std::optional<glm::dvec2> pixel;
};

/// Marks the tiles under triangles; large ones are cut until a lens cannot bend them noticeably.
class TileMask {
  public:
    explicit TileMask(const View& view)
        : view_(view),
          centre_(centre_in_world(view)),
          columns_((view.width + kTile_px - 1) / kTile_px),
          rows_((view.height + kTile_px - 1) / kTile_px),
          seen_(static_cast<std::size_t>(columns_ * rows_), 0) {}

    void add(const Corner& a, const Corner& b, const Corner& c, int depth) {
        if (everywhere_) return;
        if (needs_cut(a, b, c) && depth < 9) {
            if (++cuts_ > kMostCuts) {
                everywhere_ = true;
                return;
            }
            const Corner ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            add(a, ab, ca, depth + 1);
            add(ab, b, bc, depth + 1);
            add(ca, bc, c, depth + 1);
            add(ab, bc, ca, depth + 1);
            return;
        }
        glm::dvec2 low(1e300), high(-1e300);
        bool all = true;
        for (const Corner* corner : {&a, &b, &c}) {
            if (!corner->pixel) {
                all = false;
                continue;
            }
            low = glm::min(low, *corner->pixel);
            high = glm::max(high, *corner->pixel);
        }
        const double margin = all ? 1.0 : 2.0 * kTile_px;
        mark(low - margin, high + margin);
    }

    std::vector<glm::ivec2> tiles() const {
        std::vector<glm::ivec2> result;
        for (int y = 0; y < rows_; ++y) {
            for (int x = 0; x < columns_; ++x) {
                const bool seen = seen_[static_cast<std::size_t>(y * columns_ + x)] != 0;
                if (everywhere_ || seen) result.emplace_back(x, y);
            }
        }
        return result;
    }

  private:
    /// A tenth of a second of them. A lens that spreads the mesh over more pixels than that has
    /// room for shows it through a keyhole: every tile is then taken to see something.
    static constexpr std::size_t kMostCuts = 1'000'000;

    bool needs_cut(const Corner& a, const Corner& b, const Corner& c) const {
        if (a.pixel && b.pixel && c.pixel) {
            constexpr double kLargest_px = 48.0;
            return glm::distance(*a.pixel, *b.pixel) > kLargest_px ||
                   glm::distance(*b.pixel, *c.pixel) > kLargest_px ||
                   glm::distance(*c.pixel, *a.pixel) > kLargest_px;
        }
        const double edge = std::max({glm::distance(a.world, b.world),
                                      glm::distance(b.world, c.world),
                                      glm::distance(c.world, a.world)});
        return edge > 0.01 * glm::distance(a.world, centre_);
    }

    Corner middle(const Corner& a, const Corner& b) const {
        const glm::dvec3 world = 0.5 * (a.world + b.world);
        return {world, project(view_, world)};
    }

    void mark(glm::dvec2 low, glm::dvec2 high) {
        if (!(low.x <= high.x && low.y <= high.y)) return;
        const auto tile = [](double pixel, int count) {
            return static_cast<int>(std::floor(std::clamp(pixel / kTile_px, -1.0, count + 0.0)));
        };
        const int x_end = std::min(tile(high.x, columns_), columns_ - 1);
        const int y_end = std::min(tile(high.y, rows_), rows_ - 1);
        for (int y = std::max(tile(low.y, rows_), 0); y <= y_end; ++y) {
            for (int x = std::max(tile(low.x, columns_), 0); x <= x_end; ++x) {
                seen_[static_cast<std::size_t>(y * columns_ + x)] = 1;
            }
        }
    }

    const View& view_;
    glm::dvec3 centre_;
    int columns_, rows_;
    std::vector<std::uint8_t> seen_;
    std::size_t cuts_ = 0;
    bool everywhere_ = false;
};

std::optional<glm::dvec3> direction_at(const View& view, glm::dvec2 pixel) {
    try {
        return ray_through(view, pixel).direction;
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

}  // namespace

std::vector<glm::ivec2> tiles_that_see(const Mesh& mesh, const View& view) {
    std::vector<Corner> corners(mesh.positions_mm.size());
    parallel_for(corners.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 world(mesh.positions_mm[i]);
            corners[i] = {world, project(view, world)};
        }
    });
    TileMask mask(view);
    for (const glm::uvec3& t : mesh.triangles) {
        mask.add(corners[t.x], corners[t.y], corners[t.z], 0);
    }
    return mask.tiles();
}

TileRays::TileRays(const View& view, glm::ivec2 tile)
    : view_(&view), corner_px_(glm::dvec2(tile) * static_cast<double>(kTile_px)) {
    const glm::dvec3 axis(view.view_from_world.rotation[0][2],
                          view.view_from_world.rotation[1][2],
                          view.view_from_world.rotation[2][2]);
    for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
            const auto direction =
                direction_at(view, corner_px_ + 0.5 * kTile_px * glm::dvec2(i, j));
            if (!direction) {
                exact_ = true;
                return;
            }
            node_[static_cast<std::size_t>(3 * j + i)] = *direction / glm::dot(*direction, axis);
        }
    }
}

namespace {

/// Quadratic Lagrange weights on nodes 0, 1/2, 1.
glm::dvec3 weights(double u) {
    return {(2.0 * u - 1.0) * (u - 1.0), 4.0 * u * (1.0 - u), u * (2.0 * u - 1.0)};
}

}  // namespace

std::optional<TileRays::Row> TileRays::row(double y_px) const {
    if (exact_) return std::nullopt;
    const glm::dvec3 w = weights((y_px - corner_px_.y) / static_cast<double>(kTile_px));
    std::array<glm::dvec3, 3> node;
    for (std::size_t i = 0; i < 3; ++i) {
        node[i] = w[0] * node_[i] + w[1] * node_[3 + i] + w[2] * node_[6 + i];
    }
    return Row{node[0],
               -3.0 * node[0] + 4.0 * node[1] - node[2],
               2.0 * (node[0] - 2.0 * node[1] + node[2])};
}

std::optional<glm::vec3> TileRays::direction(glm::dvec2 pixel) const {
    if (exact_) {
        const auto direction = direction_at(*view_, pixel);
        if (!direction) return std::nullopt;
        return glm::vec3(*direction);
    }
    const glm::dvec2 u = (pixel - corner_px_) / static_cast<double>(kTile_px);
    const glm::dvec3 wx = weights(u.x), wy = weights(u.y);
    glm::dvec3 sum(0.0);
    for (int j = 0; j < 3; ++j) {
        const glm::dvec3* row = &node_[static_cast<std::size_t>(3 * j)];
        sum += wy[j] * (wx[0] * row[0] + wx[1] * row[1] + wx[2] * row[2]);
    }
    return glm::vec3(glm::normalize(sum));
}

}  // namespace livery
