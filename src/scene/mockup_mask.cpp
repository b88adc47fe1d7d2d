#include "scene/mockup_mask.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <glm/common.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace livery {
namespace {

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Sets the pixels whose centres lie in the triangle, either way round.
void fill(Image8& mask, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const glm::dvec2 size(mask.width, mask.height);
    const glm::dvec2 low = glm::max(glm::min(glm::min(a, b), c) - 0.5, glm::dvec2(0.0));
    const glm::dvec2 high = glm::min(glm::max(glm::max(a, b), c) - 0.5, size - 1.0);
    const double area = turn(a, b, c);
    if (area == 0.0 || !(low.x <= high.x) || !(low.y <= high.y)) return;
    const double sign = area > 0.0 ? 1.0 : -1.0;
    for (int y = static_cast<int>(std::ceil(low.y)); y <= static_cast<int>(high.y); ++y)
        for (int x = static_cast<int>(std::ceil(low.x)); x <= static_cast<int>(high.x); ++x) {
            const glm::dvec2 p(x + 0.5, y + 0.5);
            if (sign * turn(a, b, p) >= 0.0 && sign * turn(b, c, p) >= 0.0 &&
                sign * turn(c, a, p) >= 0.0) {
                mask.at(x, y) = 255;
            }
        }
}

}  // namespace

Image8 mockup_mask(const Mesh& mesh, const View& view) {
    std::vector<std::optional<glm::dvec2>> seen(mesh.positions_mm.size());
    parallel_for(seen.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            seen[i] = project(view, glm::dvec3(mesh.positions_mm[i]));
        }
    });
    Image8 mask(view.width, view.height, 1);
    for (const glm::uvec3& corner : mesh.triangles) {
        const auto &a = seen[corner.x], &b = seen[corner.y], &c = seen[corner.z];
        if (a && b && c) fill(mask, *a, *b, *c);
    }
    return mask;
}

Image8 coverage_mask(const ImageF& picture) {
    check_argument(picture.channels == 4,
                   "coverage mask: " + std::to_string(picture.channels) +
                       " channels, expected R, G, B and coverage");
    Image8 mask(picture.width, picture.height, 1);
    for (std::size_t i = 0; i < mask.values.size(); ++i) {
        mask.values[i] = picture.values[4 * i + 3] >= 0.5f ? 255 : 0;
    }
    return mask;
}

}  // namespace livery
