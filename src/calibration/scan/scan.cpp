#include "calibration/scan/scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/statistics.h"

namespace livery {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Distances along the projector's rays, with their deviations and the gap to the camera's ray.
struct Ranges {
    std::vector<double> mm, sigma_mm;
    std::vector<float> gap_px;
};

std::vector<Ray> rays_of(const View& view) {
    std::vector<Ray> rays(static_cast<std::size_t>(view.width) *
                          static_cast<std::size_t>(view.height));
    parallel_for(static_cast<std::size_t>(view.height), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (int x = 0; x < view.width; ++x)
                rays[y * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x)] =
                    ray_through(view, {x + 0.5, static_cast<double>(y) + 0.5});
    });
    return rays;
}

Ranges triangulate(const std::vector<Ray>& rays, const Sight& sight, const ScanOptions& options) {
    const std::size_t count = rays.size();
    Ranges ranges{std::vector<double>(count, kNone),
                  std::vector<double>(count, kNone),
                  std::vector<float>(count, -1.0f)};
    const double focal = 0.5 * (sight.camera.focal_px.x + sight.camera.focal_px.y);
    const ImageF& place = sight.map.camera_px;
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* pixel = &place.values[2 * i];
            if (!std::isfinite(pixel[0]) || !std::isfinite(pixel[1])) continue;
            if (!sight.map.edge.empty() && sight.map.edge.values[i]) continue;
            const Ray& from_projector = rays[i];
            const Ray from_camera = ray_through(sight.camera, {pixel[0], pixel[1]});
            const glm::dvec3 normal = glm::cross(from_projector.direction, from_camera.direction);
            const double sine2 = glm::dot(normal, normal);
            if (sine2 < std::pow(std::sin(options.least_angle_rad), 2.0)) continue;
            const glm::dvec3 between = from_camera.origin - from_projector.origin;
            const double range =
                glm::dot(glm::cross(between, from_camera.direction), normal) / sine2;
            const double camera_range =
                glm::dot(glm::cross(between, from_projector.direction), normal) / sine2;
            if (!(range > 0.0) || !(camera_range > 0.0)) continue;
            const double gap = std::abs(glm::dot(between, normal)) / std::sqrt(sine2);
            ranges.gap_px[i] = static_cast<float>(gap * focal / camera_range);
            ranges.mm[i] = range;
            ranges.sigma_mm[i] = sight.map.sigma_px * camera_range / focal / std::sqrt(sine2);
        }
    });
    return ranges;
}

/// The mean of what the sights say, weighted by their deviations.
Ranges merged(const std::vector<Ranges>& all) {
    Ranges result = all.front();
    for (std::size_t i = 0; i < result.mm.size(); ++i) {
        double weights = 0.0, sum = 0.0, low = 1e300, high = 0.0;
        for (const Ranges& one : all) {
            if (!std::isfinite(one.mm[i])) continue;
            const double weight = 1.0 / (one.sigma_mm[i] * one.sigma_mm[i]);
            weights += weight;
            sum += weight * one.mm[i];
            low = std::min(low, one.mm[i]);
            high = std::max(high, one.mm[i]);
        }
        const bool agree = weights > 0.0 && high - low < 0.01 * low;
        result.mm[i] = agree ? sum / weights : kNone;
        result.sigma_mm[i] = agree ? 1.0 / std::sqrt(weights) : kNone;
    }
    return result;
}

/// Pieces that hang together, over neighbours to the right and below; the small ones are taken out.
void remove_small_patches(Ranges& ranges,
                          const View& projector,
                          double pixel_angle,
                          const ScanOptions& options) {
    const int width = projector.width, height = projector.height;
    std::vector<std::uint32_t> patch(ranges.mm.size(), 0), stack, members;
    for (std::uint32_t start = 0; start < patch.size(); ++start) {
        if (patch[start] || !std::isfinite(ranges.mm[start])) continue;
        members.clear();
        stack.assign(1, start);
        patch[start] = 1;
        while (!stack.empty()) {
            const std::uint32_t at = stack.back();
            stack.pop_back();
            members.push_back(at);
            const int x = static_cast<int>(at) % width, y = static_cast<int>(at) / width;
            const auto visit = [&](int nx, int ny) {
                if (nx < 0 || ny < 0 || nx >= width || ny >= height) return;
                const auto next = static_cast<std::uint32_t>(ny * width + nx);
                if (patch[next] || !std::isfinite(ranges.mm[next])) return;
                const double sigma = std::max(ranges.sigma_mm[at], ranges.sigma_mm[next]);
                if (!on_one_surface(
                        ranges.mm[at], ranges.mm[next], pixel_angle, sigma, options.steepest_rad))
                    return;
                patch[next] = 1;
                stack.push_back(next);
            };
            visit(x - 1, y);
            visit(x + 1, y);
            visit(x, y - 1);
            visit(x, y + 1);
        }
        if (members.size() >= static_cast<std::size_t>(options.least_patch_px)) continue;
        for (const std::uint32_t member : members) ranges.mm[member] = kNone;
    }
}

/// From the means of the columns and rows of 5 x 5 points that lie on one surface with the middle.
std::optional<glm::dvec3> normal_at(
    const Scan& scan, const Ranges& ranges, int x, int y, double pixel_angle, double steepest) {
    constexpr int kReach = 2;
    const ImageF& points = scan.points_mm;
    const auto middle = static_cast<std::size_t>(y * points.width + x);
    glm::dvec3 side[4] = {};
    int count[4] = {};
    for (int dy = -kReach; dy <= kReach; ++dy)
        for (int dx = -kReach; dx <= kReach; ++dx) {
            const int nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= points.width || ny >= points.height) continue;
            const auto at = static_cast<std::size_t>(ny * points.width + nx);
            if (!std::isfinite(ranges.mm[at])) continue;
            const double apart = pixel_angle * std::max(std::abs(dx), std::abs(dy));
            if (!on_one_surface(
                    ranges.mm[middle], ranges.mm[at], apart, ranges.sigma_mm[middle], steepest))
                continue;
            const float* p = points.pixel(nx, ny);
            const glm::dvec3 point(p[0], p[1], p[2]);
            const auto add = [&](int which) {
                side[which] += point;
                ++count[which];
            };
            if (dx < 0) add(0);
            if (dx > 0) add(1);
            if (dy < 0) add(2);
            if (dy > 0) add(3);
        }
    for (int k = 0; k < 4; ++k) {
        if (count[k] < 4) return std::nullopt;
        side[k] /= count[k];
    }
    const glm::dvec3 normal = glm::cross(side[3] - side[2], side[1] - side[0]);
    const double length = glm::length(normal);
    if (!(length > 0.0)) return std::nullopt;
    const float* p = points.pixel(x, y);
    const glm::dvec3 to_projector = centre_in_world(scan.projector) - glm::dvec3(p[0], p[1], p[2]);
    return normal * (glm::dot(normal, to_projector) < 0.0 ? -1.0 / length : 1.0 / length);
}

/// Takes out what passes too far; the median.
double gap_of(Ranges& ranges, const View& camera, const ScanOptions& options) {
    std::vector<float> gaps;
    for (const float gap : ranges.gap_px)
        if (gap >= 0.0f) gaps.push_back(gap);
    const auto middle = static_cast<double>(median(gaps));
    if (middle > options.refused_gap * camera.width)
        throw Refused(
            fmt::format("the rays of camera and projector pass each other by {:.1f} camera pixels "
                        "(median)",
                        middle),
            "camera or projector moved, or was zoomed, after the geometry was calibrated: "
            "calibrate the geometry again (livery calibrate geometry)");
    const auto limit = static_cast<float>(std::max(options.largest_gap_px, 4.0 * middle));
    for (std::size_t i = 0; i < ranges.mm.size(); ++i)
        if (ranges.gap_px[i] > limit) ranges.mm[i] = ranges.sigma_mm[i] = kNone;
    return middle;
}

/// Rays that meet worse than the photographs are noisy: lenses or poses are not what they were. A
/// movement along the line between the two lenses moves points in depth, and is not seen here.
void tell_gap(const Sight& sight, double gap_px, const ScanOptions& options, Scan& scan) {
    const double sigma_px = sight.map.sigma_px;
    if (gap_px < options.told_gap_px || gap_px < options.told_gap_sigmas * sigma_px) return;
    scan.warnings.push_back(fmt::format(
        "the rays of camera and projector pass each other by {:.2f} camera pixels (median), where "
        "places are good to {:.2f}: camera or projector may have moved since the geometry was "
        "calibrated; calibrate it again",
        gap_px,
        sigma_px));
}

}  // namespace

bool on_one_surface(double range_a_mm,
                    double range_b_mm,
                    double pixel_angle_rad,
                    double sigma_mm,
                    double steepest_rad) {
    const double across = std::min(range_a_mm, range_b_mm) * pixel_angle_rad;
    return std::abs(range_a_mm - range_b_mm) < across * std::tan(steepest_rad) + 3.0 * sigma_mm;
}

Scan scan_of(const View& projector, std::span<const Sight> sights, const ScanOptions& options) {
    check_argument(!sights.empty(), "a scan takes one position of the camera or more");
    const std::vector<Ray> rays = rays_of(projector);
    std::vector<Ranges> all;
    Scan scan;
    scan.projector = projector;
    for (const Sight& sight : sights) {
        check_argument(sight.map.camera_px.width == projector.width &&
                           sight.map.camera_px.height == projector.height,
                       "the map has other pixels than the projector");
        if (is_mirrored(sight.map))
            throw Refused("the photographs are mirrored",
                          "switch off mirroring (rear or ceiling projection, a camera's selfie "
                          "picture) in the projector or the camera, and photograph again");
        all.push_back(triangulate(rays, sight, options));
        const double gap_px = gap_of(all.back(), sight.camera, options);
        scan.gap_px = std::max(scan.gap_px, gap_px);
        tell_gap(sight, gap_px, options, scan);
    }
    Ranges ranges = merged(all);
    const double pixel_angle = 2.0 / (projector.focal_px.x + projector.focal_px.y);
    remove_small_patches(ranges, projector, pixel_angle, options);

    const float nan = std::numeric_limits<float>::quiet_NaN();
    scan.points_mm = ImageF(projector.width, projector.height, 3, nan);
    scan.normals = ImageF(projector.width, projector.height, 3, nan);
    scan.sigma_mm = ImageF(projector.width, projector.height, 1, nan);
    std::size_t known = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!std::isfinite(ranges.mm[i])) continue;
        ++known;
        const glm::dvec3 point = rays[i].origin + ranges.mm[i] * rays[i].direction;
        for (int c = 0; c < 3; ++c)
            scan.points_mm.values[3 * i + static_cast<std::size_t>(c)] =
                static_cast<float>(point[c]);
        scan.sigma_mm.values[i] = static_cast<float>(ranges.sigma_mm[i]);
    }
    scan.known_fraction = static_cast<double>(known) / static_cast<double>(rays.size());
    if (known < 500)
        throw Refused(
            fmt::format("only {} projector pixels have a place in space", known),
            "light more of the mock-up, and let the camera see what the projector lights");
    const auto rows = static_cast<std::size_t>(projector.height);
    parallel_for(rows, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (int x = 0; x < projector.width; ++x) {
                const int row = static_cast<int>(y);
                if (!std::isfinite(scan.sigma_mm.at(x, row))) continue;
                const auto normal =
                    normal_at(scan, ranges, x, row, pixel_angle, options.steepest_rad);
                if (!normal) continue;
                for (int c = 0; c < 3; ++c)
                    scan.normals.at(x, row, c) = static_cast<float>((*normal)[c]);
            }
    });
    return scan;
}

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
