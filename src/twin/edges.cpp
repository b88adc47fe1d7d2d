#include "twin/edges.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace livery {

PixelGround::PixelGround(const View& view)
    : seen(view.width, view.height, 1),
      lit(view.width, view.height, 1),
      mixed(view.width, view.height, 1),
      part(view.width, view.height, 1, 0xffff),
      place(view.width, view.height, 6) {}

Image8 edge_band(const PixelGround& ground, const View& view, const PixelRectangle& rectangle) {
    const glm::dvec3 view_mm = centre_in_world(view);
    const auto is_edge = [&](int x, int y, int u, int v) {
        if (ground.part.at(x, y) != ground.part.at(u, v)) return true;
        if (!ground.lit.at(x, y) || !ground.lit.at(u, v)) return false;
        const float* a = ground.place.pixel(x, y);
        const float* b = ground.place.pixel(u, v);
        const glm::dvec3 step(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        const double off_a = std::abs(step.x * a[3] + step.y * a[4] + step.z * a[5]);
        const double off_b = std::abs(step.x * b[3] + step.y * b[4] + step.z * b[5]);
        const double pixel_mm =
            glm::length(glm::dvec3(a[0], a[1], a[2]) - view_mm) / view.focal_px.x;
        return std::min(off_a, off_b) > 2.0 * pixel_mm;
    };
    constexpr int kReach = 2;
    Image8 band(view.width, view.height, 1);
    for (int y = rectangle.top; y < rectangle.bottom; ++y) {
        for (int x = rectangle.left; x < rectangle.right; ++x) {
            bool edge = ground.mixed.at(x, y) != 0;
            if (!edge && x + 1 < view.width) edge = is_edge(x, y, x + 1, y);
            if (!edge && y + 1 < view.height) edge = is_edge(x, y, x, y + 1);
            if (!edge) continue;
            for (int v = std::max(0, y - kReach); v <= std::min(view.height - 1, y + kReach); ++v) {
                for (int u = std::max(0, x - kReach); u <= std::min(view.width - 1, x + kReach);
                     ++u) {
                    band.at(u, v) = 255;
                }
            }
        }
    }
    return band;
}

}  // namespace livery
