// Which of a picture's pixels a triangle covers.
#pragma once

#include <cmath>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/image.h"
#include "mesh/mesh.h"
#include "scene/view.h"

namespace livery {

/// Twice the area, positive where a, b, c turn from x to y.
inline double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// visit(x, y, weights) for each pixel of a picture of this size whose centre lies in the triangle,
/// either way round; the weights of a, b and c sum to 1.
template <typename Visit>
void for_each_pixel(glm::ivec2 size_px,
                    const glm::dvec2& a,
                    const glm::dvec2& b,
                    const glm::dvec2& c,
                    Visit visit) {
    const glm::dvec2 low = glm::max(glm::min(glm::min(a, b), c) - 0.5, glm::dvec2(0.0));
    const glm::dvec2 high = glm::min(glm::max(glm::max(a, b), c) - 0.5, glm::dvec2(size_px) - 1.0);
    const double area = turn(a, b, c);
    if (area == 0.0 || !(low.x <= high.x) || !(low.y <= high.y)) return;
    for (int y = static_cast<int>(std::ceil(low.y)); y <= static_cast<int>(high.y); ++y)
        for (int x = static_cast<int>(std::ceil(low.x)); x <= static_cast<int>(high.x); ++x) {
            const glm::dvec2 p(x + 0.5, y + 0.5);
            const glm::dvec3 weights =
                glm::dvec3(turn(b, c, p), turn(c, a, p), turn(a, b, p)) / area;
            if (weights.x >= 0.0 && weights.y >= 0.0 && weights.z >= 0.0) visit(x, y, weights);
        }
}

/// 255 where the pixel's centre looks at the mesh, whichever part is in front; one channel.
Image8 mockup_mask(const Mesh& mesh, const View& view);

/// 255 where a picture with coverage in its fourth channel is covered by half or more.
Image8 coverage_mask(const ImageF& picture);

/// What wireframe_picture() is made of, 8-bit RGB.
struct WireframeColours {
    glm::u8vec3 outline{90, 255, 90};   ///< the mock-up's border, and where it hides itself
    glm::u8vec3 line{255, 255, 255};    ///< creases and the borders of parts
    glm::u8vec3 elsewhere{56, 56, 56};  ///< little light, by which the mock-up itself is seen
};

/// Lines a pixel wide along the mesh's outlines, creases of more than 30 degrees and borders
/// between parts, hidden ones left out; 3 channels of the view's size. Coarse facets show as
/// creases.
Image8 wireframe_picture(const Mesh& mesh, const View& view, const WireframeColours& colours = {});

}  // namespace livery
