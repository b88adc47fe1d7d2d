#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "calibration/scan/scan.h"
#include "core/error.h"
#include "core/statistics.h"

namespace livery {

namespace {

glm::vec3 point_at(const Scan& scan, int x, int y) {
    const float* p = scan.points_mm.pixel(x, y);
    return {p[0], p[1], p[2]};
}

}  // namespace

double point_spacing(const Scan& scan) {
    std::vector<float> spacing;
    for (int y = 0; y < scan.points_mm.height; y += 4)
        for (int x = 0; x + 1 < scan.points_mm.width; x += 4) {
            const float apart = glm::length(point_at(scan, x, y) - point_at(scan, x + 1, y));
            if (std::isfinite(apart)) spacing.push_back(apart);
        }
    return static_cast<double>(median(spacing));
}

Mesh mesh_of_scan(const Scan& scan, int step, double steepest_rad) {
    check_argument(step >= 1, "every how manieth pixel: 1 or more");
    const int width = (scan.points_mm.width + step - 1) / step;
    const int height = (scan.points_mm.height + step - 1) / step;
    const glm::dvec3 lamp = centre_in_world(scan.projector);
    const double pixel_angle = 2.0 * step / (scan.projector.focal_px.x + scan.projector.focal_px.y);
    const auto known = [&](int x, int y) {
        return std::isfinite(scan.sigma_mm.at(x * step, y * step));
    };
    const auto range = [&](int x, int y) {
        return glm::length(glm::dvec3(point_at(scan, x * step, y * step)) - lamp);
    };
    using Corner = std::array<int, 2>;
    const auto joined = [&](const Corner& a, const Corner& b) {
        const bool diagonal = a[0] != b[0] && a[1] != b[1];
        const double sigma =
            static_cast<double>(std::max(scan.sigma_mm.at(a[0] * step, a[1] * step),
                                         scan.sigma_mm.at(b[0] * step, b[1] * step)));
        return on_one_surface(range(a[0], a[1]),
                              range(b[0], b[1]),
                              pixel_angle * (diagonal ? std::sqrt(2.0) : 1.0),
                              sigma,
                              steepest_rad);
    };

    Mesh mesh;
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> vertex(
        static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNone);
    const auto vertex_of = [&](const Corner& corner) {
        std::uint32_t& index = vertex[static_cast<std::size_t>(corner[1] * width + corner[0])];
        if (index == kNone) {
            index = static_cast<std::uint32_t>(mesh.positions_mm.size());
            mesh.positions_mm.push_back(point_at(scan, corner[0] * step, corner[1] * step));
        }
        return index;
    };
    const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
        if (!joined(a, b) || !joined(b, c) || !joined(c, a)) return;
        mesh.triangles.push_back({vertex_of(a), vertex_of(b), vertex_of(c)});
    };
    for (int y = 0; y + 1 < height; ++y)
        for (int x = 0; x + 1 < width; ++x) {
            // Rows go down, so this way round is counter-clockwise seen from the projector.
            const Corner corners[4] = {{x, y}, {x, y + 1}, {x + 1, y + 1}, {x + 1, y}};
            int missing = -1, count = 0;
            for (int k = 0; k < 4; ++k) {
                if (known(corners[k][0], corners[k][1])) {
                    ++count;
                } else {
                    missing = k;
                }
            }
            if (count == 3) {
                add(corners[(missing + 1) % 4],
                    corners[(missing + 2) % 4],
                    corners[(missing + 3) % 4]);
            } else if (count == 4) {
                const auto apart = [&](int a, int b) {
                    return std::abs(range(corners[a][0], corners[a][1]) -
                                    range(corners[b][0], corners[b][1]));
                };
                const int first = apart(0, 2) <= apart(1, 3) ? 0 : 1;
                add(corners[first], corners[first + 1], corners[first + 2]);
                add(corners[first], corners[first + 2], corners[(first + 3) % 4]);
            }
        }
    if (mesh.triangles.empty())
        throw Refused("no neighbouring points of the scan hang together",
                      "bring camera and projector nearer to the mock-up, and focus both");
    mesh.triangle_part.assign(mesh.triangles.size(), 0);
    mesh.uvs.assign(mesh.positions_mm.size(), glm::vec2(0.0f));
    mesh.parts.resize(1);
    mesh.parts.front().name = "scan";
    compute_normals(mesh);
    compute_tangents(mesh);
    return mesh;
}

}  // namespace livery
