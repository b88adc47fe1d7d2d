#include "scene/mockup_mask.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"

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

namespace {

constexpr double kCrease_cos = 0.866;  // 30 degrees
/// Two neighbouring pixels belong to one surface when either lies so close to the other's facet, of
/// the mesh's size: a step smaller than this is no outline.
constexpr double kStep = 0.01;
constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

/// The nearest triangle of each pixel.
struct Front {
    std::vector<std::uint32_t> triangle;
    std::vector<float> inverse_depth;  ///< along the view's axis, 1 / mm
};

Front front_of(const Mesh& mesh, const View& view) {
    struct Corner {
        std::optional<glm::dvec2> pixel;
        double inverse_depth = 0.0;
    };
    std::vector<Corner> corners(mesh.positions_mm.size());
    parallel_for(corners.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const glm::dvec3 x(mesh.positions_mm[i]);
            corners[i] = {project(view, x), 1.0 / (view.view_from_world * x).z};
        }
    });
    const auto pixels =
        static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
    Front front{std::vector<std::uint32_t>(pixels, kNothing), std::vector<float>(pixels, 0.0f)};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& index = mesh.triangles[t];
        const Corner &a = corners[index.x], &b = corners[index.y], &c = corners[index.z];
        if (!a.pixel || !b.pixel || !c.pixel) continue;
        // The inverse of the depth is linear across a facet's picture.
        const glm::dvec3 inverse(a.inverse_depth, b.inverse_depth, c.inverse_depth);
        for_each_pixel({view.width, view.height},
                       *a.pixel,
                       *b.pixel,
                       *c.pixel,
                       [&](int x, int y, const glm::dvec3& weights) {
                           const auto at =
                               static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                               static_cast<std::size_t>(x);
                           const auto nearness = static_cast<float>(glm::dot(weights, inverse));
                           if (nearness <= front.inverse_depth[at]) return;
                           front.inverse_depth[at] = nearness;
                           front.triangle[at] = static_cast<std::uint32_t>(t);
                       });
    }
    return front;
}

enum class LineKind { none, line, outline };

/// Between two facets that are seen side by side.
LineKind edge_between(const Mesh& mesh, std::uint32_t one, std::uint32_t other, double step_mm) {
    if (one == other) return LineKind::none;
    if (one == kNothing || other == kNothing) return LineKind::outline;
    struct Facet {
        glm::dvec3 a, b, c, normal;
    };
    const auto facet = [&](std::uint32_t t) {
        const glm::uvec3& index = mesh.triangles[t];
        Facet f{glm::dvec3(mesh.positions_mm[index.x]),
                glm::dvec3(mesh.positions_mm[index.y]),
                glm::dvec3(mesh.positions_mm[index.z]),
                {}};
        const glm::dvec3 normal = glm::cross(f.b - f.a, f.c - f.a);
        f.normal = normal / std::max(glm::length(normal), 1e-300);
        return f;
    };
    const Facet f = facet(one), g = facet(other);
    // Seen side by side, but one lies before the other: even its nearest corner is off the plane.
    const auto off = [](const Facet& plane, const Facet& of) {
        double nearest = std::numeric_limits<double>::max();
        for (const glm::dvec3& corner : {of.a, of.b, of.c})
            nearest = std::min(nearest, std::abs(glm::dot(plane.normal, corner - plane.a)));
        return nearest;
    };
    if (off(f, g) > step_mm && off(g, f) > step_mm) return LineKind::outline;
    const bool other_part = mesh.triangle_part[one] != mesh.triangle_part[other];
    return other_part || std::abs(glm::dot(f.normal, g.normal)) < kCrease_cos ? LineKind::line
                                                                              : LineKind::none;
}

}  // namespace

Image8 wireframe_picture(const Mesh& mesh, const View& view, const WireframeColours& colours) {
    const Front front = front_of(mesh, view);
    const Bounds bounds = bounds_of(mesh);
    const double step_mm = kStep * glm::distance(bounds.low, bounds.high);
    Image8 picture(view.width, view.height, 3);
    const auto width = static_cast<std::size_t>(view.width);
    parallel_for(
        static_cast<std::size_t>(view.height), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y)
                for (std::size_t x = 0; x < width; ++x) {
                    const std::size_t at = y * width + x;
                    LineKind edge = LineKind::none;
                    const auto look_at_pixel = [&](std::size_t neighbour) {
                        edge = std::max(
                            edge,
                            edge_between(
                                mesh, front.triangle[at], front.triangle[neighbour], step_mm));
                    };
                    if (x > 0) look_at_pixel(at - 1);
                    if (y > 0) look_at_pixel(at - width);
                    const glm::u8vec3& colour = edge == LineKind::outline ? colours.outline
                                                : edge == LineKind::line  ? colours.line
                                                                          : colours.elsewhere;
                    for (int c = 0; c < 3; ++c)
                        picture.at(static_cast<int>(x), static_cast<int>(y), c) = colour[c];
                }
        });
    return picture;
}

}  // namespace livery
