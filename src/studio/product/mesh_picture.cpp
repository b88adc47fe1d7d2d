#include "studio/product/mesh_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "scene/mockup_mask.h"

namespace livery {

namespace {

constexpr int kSamples = 2;  // a side of a pixel
constexpr float kElevation_rad = 0.4f;
constexpr float kGroundGrey = 0.05f, kDarkest = 0.05f, kLit = 0.33f;

/// Rows: right, up and towards the viewer.
glm::mat3 view_from_world(float azimuth_rad) {
    const glm::vec3 towards(std::cos(kElevation_rad) * std::sin(azimuth_rad),
                            std::sin(kElevation_rad),
                            std::cos(kElevation_rad) * std::cos(azimuth_rad));
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), towards));
    return glm::transpose(glm::mat3(right, glm::cross(towards, right), towards));
}

struct Canvas {
    glm::ivec2 size;
    std::vector<float> depth, grey;  ///< grey below 0: nothing

    explicit Canvas(glm::ivec2 px)
        : size(px),
          depth(static_cast<std::size_t>(px.x) * static_cast<std::size_t>(px.y),
                -std::numeric_limits<float>::infinity()),
          grey(depth.size(), -1.0f) {}

    /// Corners: x, y in samples, rows down; z grows towards the viewer.
    void draw(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, float shade) {
        const glm::dvec3 depths(a.z, b.z, c.z);
        for_each_pixel(size,
                       glm::dvec2(a),
                       glm::dvec2(b),
                       glm::dvec2(c),
                       [&](int x, int y, const glm::dvec3& weights) {
                           const auto z = static_cast<float>(glm::dot(weights, depths));
                           const auto at =
                               static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) +
                               static_cast<std::size_t>(x);
                           if (z <= depth[at]) return;
                           depth[at] = z;
                           grey[at] = shade;
                       });
    }
};

Image8 averaged(const Canvas& canvas, glm::ivec2 size_px) {
    Image8 picture(size_px.x, size_px.y, 4);
    constexpr int kSamplesOfPixel = kSamples * kSamples;
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) {
            float sum = 0.0f;
            int there = 0;
            for (int k = 0; k < kSamplesOfPixel; ++k) {
                const int row = y * kSamples + k / kSamples, column = x * kSamples + k % kSamples;
                const float grey = canvas.grey[static_cast<std::size_t>(row) *
                                                   static_cast<std::size_t>(canvas.size.x) +
                                               static_cast<std::size_t>(column)];
                if (grey < 0.0f) continue;
                sum += grey;
                ++there;
            }
            const std::size_t at =
                4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px.x) +
                     static_cast<std::size_t>(x));
            const float mean = there > 0 ? sum / static_cast<float>(there) : 0.0f;
            for (std::size_t c = 0; c < 3; ++c) {
                picture.values[at + c] = static_cast<std::uint8_t>(
                    std::lround(255.0f * std::pow(std::min(mean, 1.0f), 1.0f / 2.2f)));
            }
            picture.values[at + 3] = static_cast<std::uint8_t>(255 * there / kSamplesOfPixel);
        }
    }
    return picture;
}

}  // namespace

Image8 mesh_picture(const Mesh& mesh,
                    const glm::dmat3& world_from_mesh,
                    glm::ivec2 size_px,
                    double azimuth_rad) {
    check_argument(size_px.x > 0 && size_px.y > 0 && size_px.x <= 2048 && size_px.y <= 2048,
                   "mesh_picture: a size of 1 to 2048");
    const glm::mat3 rotation(world_from_mesh),
        view = view_from_world(static_cast<float>(azimuth_rad));
    const glm::mat3 view_from_mesh = view * rotation;
    std::vector<glm::vec3> points;
    points.reserve(mesh.positions_mm.size() + 4);
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& position : mesh.positions_mm) {
        const glm::vec3 world = rotation * position;
        low = glm::min(low, world);
        high = glm::max(high, world);
        points.push_back(view_from_mesh * position);
    }
    if (points.empty()) return averaged(Canvas(kSamples * size_px), size_px);
    // The ground reaches a little beyond the product.
    const glm::vec3 rim(0.08f * std::max(high.x - low.x, high.z - low.z), 0.0f, 0.0f);
    const std::size_t ground = points.size();
    for (const glm::vec2& corner :
         {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
        points.push_back(view * glm::vec3(glm::mix(low.x - rim.x, high.x + rim.x, corner.x),
                                          low.y,
                                          glm::mix(low.z - rim.x, high.z + rim.x, corner.y)));
    }
    glm::vec3 near(std::numeric_limits<float>::max()), far(-near);
    for (const glm::vec3& point : points) {
        near = glm::min(near, point);
        far = glm::max(far, point);
    }
    const glm::vec2 samples(kSamples * size_px), extent(glm::max(far - near, glm::vec3(1e-20f)));
    const float scale = 0.94f * std::min(samples.x / extent.x, samples.y / extent.y);
    const glm::vec3 middle = 0.5f * (near + far);
    for (glm::vec3& point : points) {
        point = (point - middle) * scale;
        point = {0.5f * samples.x + point.x, 0.5f * samples.y - point.y, point.z};
    }
    Canvas canvas(kSamples * size_px);
    canvas.draw(points[ground], points[ground + 1], points[ground + 2], kGroundGrey);
    canvas.draw(points[ground], points[ground + 2], points[ground + 3], kGroundGrey);
    const glm::vec3 light = glm::normalize(view * glm::vec3(0.25f, 1.0f, 0.55f));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 &a = points[t.x], &b = points[t.y], &c = points[t.z];
        glm::vec3 normal = glm::cross(b - a, c - a);
        const float length = glm::length(normal);
        if (length == 0.0f) continue;
        // Rows go down here, and whichever side is seen faces the viewer.
        normal = glm::vec3(normal.x, -normal.y, normal.z) / length;
        if (normal.z < 0.0f) normal = -normal;
        const float lit = std::max(0.0f, glm::dot(normal, light));
        canvas.draw(a, b, c, kDarkest + kLit * lit);
    }
    return averaged(canvas, size_px);
}

}  // namespace livery
