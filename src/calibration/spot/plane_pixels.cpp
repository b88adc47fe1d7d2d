#include "calibration/spot/plane_pixels.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/parallel.h"

namespace livery {

namespace {

/// Area by the places of a pixel's neighbours; at the picture's edge, of itself and one neighbour.
float area_of(const PlanePixels& pixels, int x, int y) {
    const int left = std::max(x - 1, 0), right = std::min(x + 1, pixels.width - 1);
    const int up = std::max(y - 1, 0), down = std::min(y + 1, pixels.height - 1);
    const float *l = pixels.pixel(left, y), *r = pixels.pixel(right, y);
    const float *u = pixels.pixel(x, up), *d = pixels.pixel(x, down);
    for (const float* one : {l, r, u, d}) {
        if (!(one[3] > 0.0f)) return 0.0f;
    }
    const auto columns = static_cast<float>(right - left), rows = static_cast<float>(down - up);
    const float across = (r[0] - l[0]) * (d[1] - u[1]) - (r[1] - l[1]) * (d[0] - u[0]);
    return columns > 0.0f && rows > 0.0f ? std::abs(across) / (columns * rows) : 0.0f;
}

}  // namespace

glm::dvec3 axis_across(const SamplePlane& plane) {
    const glm::dvec3& n = plane.normal;
    const glm::dvec3 helper = std::abs(n.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(helper - glm::dot(helper, n) * n);
}

PlanePixels plane_pixels(const View& view, const SamplePlane& plane) {
    const glm::dvec3 across = axis_across(plane), along = glm::cross(plane.normal, across);
    PlanePixels pixels(view.width, view.height, 4);
    const auto height = static_cast<std::size_t>(view.height);
    parallel_for(height, 8, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < view.width; ++x) {
                const auto ray = find_ray(view, {x + 0.5, y + 0.5});
                if (!ray) continue;
                const double cosine = -glm::dot(ray->direction, plane.normal);
                const double above = glm::dot(ray->origin - plane.point_mm, plane.normal);
                if (!(cosine > 1e-3 && above > 0.0)) continue;
                const glm::dvec3 at =
                    ray->origin + above / cosine * ray->direction - plane.point_mm;
                float* pixel = pixels.pixel(x, y);
                pixel[0] = static_cast<float>(glm::dot(at, across));
                pixel[1] = static_cast<float>(glm::dot(at, along));
                pixel[3] = static_cast<float>(cosine);
            }
        }
    });
    parallel_for(height, 8, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < view.width; ++x) pixels.at(x, y, 2) = area_of(pixels, x, y);
        }
    });
    return pixels;
}

}  // namespace livery
