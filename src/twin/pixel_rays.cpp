#include "twin/pixel_rays.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/parallel.h"
#include "core/random.h"

namespace livery {

PixelRectangle pixels_that_see(const View& view, const Mesh& mesh, int margin_px) {
    glm::dvec2 low(1e30), high(-1e30);
    for (const glm::vec3& vertex : mesh.positions_mm) {
        const auto pixel = project(view, glm::dvec3(vertex));
        if (!pixel) return {0, 0, view.width, view.height};
        low = glm::min(low, *pixel);
        high = glm::max(high, *pixel);
    }
    const auto clamped = [](double value, int limit) {
        return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
    };
    return {clamped(std::floor(low.x) - margin_px, view.width),
            clamped(std::floor(low.y) - margin_px, view.height),
            clamped(std::ceil(high.x) + margin_px, view.width),
            clamped(std::ceil(high.y) + margin_px, view.height)};
}

PixelRays::PixelRays(const View& view, const PixelRectangle& rectangle, int samples_a_side)
    : origin_(centre_in_world(view)),
      rectangle_(rectangle),
      stride_(static_cast<std::size_t>(rectangle.right - rectangle.left + 1)),
      samples_(samples_a_side) {
    const auto rows = static_cast<std::size_t>(rectangle.bottom - rectangle.top + 1);
    corners_.resize(stride_ * rows);
    parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            for (std::size_t column = 0; column < stride_; ++column) {
                const glm::dvec2 pixel(rectangle.left + static_cast<int>(column),
                                       rectangle.top + static_cast<int>(row));
                corners_[row * stride_ + column] = glm::vec3(ray_through(view, pixel).direction);
            }
        }
    });
}

void PixelRays::add(int x, int y, std::vector<TraceRay>& rays) const {
    const auto* corner = corners_.data() + static_cast<std::size_t>(y - rectangle_.top) * stride_ +
                         static_cast<std::size_t>(x - rectangle_.left);
    const glm::vec3 dx = corner[1] - corner[0], dy = corner[stride_] - corner[0],
                    dxy = corner[stride_ + 1] - corner[stride_] - dx;
    const float step = 1.0f / static_cast<float>(samples_);
    for (int s = 0; s < samples_ * samples_; ++s) {
        const auto bits = hash_3d(static_cast<std::uint32_t>(x),
                                  static_cast<std::uint32_t>(y),
                                  static_cast<std::uint32_t>(s));
        const float jx = static_cast<float>(bits & 0xffffu) * 0x1p-16f;
        const float jy = static_cast<float>(bits >> 16u) * 0x1p-16f;
        const float u = (static_cast<float>(s % samples_) + jx) * step;
        const float v = (static_cast<float>(s / samples_) + jy) * step;
        TraceRay ray;
        ray.origin = origin_;
        ray.direction = glm::normalize(corner[0] + u * dx + v * dy + u * v * dxy);
        rays.push_back(ray);
    }
}

}  // namespace livery
