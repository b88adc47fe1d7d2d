#include "scene/mockup_mask.h"

#include <optional>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "scene/triangle_pixels.h"

namespace livery {

Image8 mockup_mask(const Mesh& mesh, const View& view) {
    std::vector<std::optional<glm::dvec2>> seen(mesh.positions_mm.size());
    parallel_for(seen.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            seen[i] = project(view, glm::dvec3(mesh.positions_mm[i]));
        }
    });
    Image8 mask(view.width, view.height, 1);
    const glm::ivec2 size_px(view.width, view.height);
    for (const glm::uvec3& corner : mesh.triangles) {
        const auto &a = seen[corner.x], &b = seen[corner.y], &c = seen[corner.z];
        if (!a || !b || !c) continue;
        for_each_pixel(
            size_px, *a, *b, *c, [&](int x, int y, const glm::dvec3&) { mask.at(x, y) = 255; });
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
