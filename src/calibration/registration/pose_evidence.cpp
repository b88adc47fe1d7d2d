#include "calibration/registration/pose_evidence.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace livery {

namespace {

/// Flatter against the camera's or the projector's ray, a surface is hardly lit or hardly decoded.
constexpr double kGrazing = 0.2;

bool seen_by(const Sight& sight,
             const Tracer& tracer,
             const Rigid3& scan_from_mesh,
             const glm::dvec3& place,
             const glm::dvec3& normal) {
    const auto pixel = project(sight.camera, scan_from_mesh * place);
    if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x >= sight.camera.width ||
        pixel->y >= sight.camera.height)
        return false;
    const glm::dvec3 to_camera = inverse(scan_from_mesh) * centre_in_world(sight.camera) - place;
    const double distance = glm::length(to_camera);
    if (glm::dot(to_camera, normal) < kGrazing * distance) return false;
    TraceRay ray;
    ray.origin = offset_origin(glm::vec3(place), glm::vec3(normal));
    ray.direction = glm::vec3(to_camera / distance);
    ray.t_max = static_cast<float>(distance);
    return !tracer.occluded(ray);
}

/// Whether the scan runs on as a plane from one pixel, which has a normal, to another.
bool goes_on(const Scan& scan, const glm::ivec2& from, const glm::ivec2& to) {
    const float *a = scan.points_mm.pixel(from.x, from.y), *n = scan.normals.pixel(from.x, from.y);
    const float* b = scan.points_mm.pixel(to.x, to.y);
    if (!std::isfinite(b[0])) return false;
    const glm::dvec3 apart(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    const double off = std::abs(glm::dot(apart, glm::dvec3(n[0], n[1], n[2])));
    const auto sigma = static_cast<double>(scan.sigma_mm.at(from.x, from.y));
    constexpr double kBend = 0.15;
    return off < kBend * glm::length(apart) + 2.0 * sigma;
}

}  // namespace

int stride_for(const View& projector, int count) {
    const double pixels = static_cast<double>(projector.width) * projector.height;
    return std::max(1, static_cast<int>(std::sqrt(pixels / count)));
}

PoseEvidence evidence_of(const Tracer& tracer,
                         const Mesh& mesh,
                         const Rigid3& scan_from_mesh,
                         const Scan& scan,
                         std::span<const Sight> sights,
                         const Image8& ignored,
                         double within_mm,
                         int stride) {
    const Rigid3 mesh_from_scan = inverse(scan_from_mesh);
    const View& projector = scan.projector;
    // Only where the mesh's box falls in the picture.
    const Bounds box = bounds_of(mesh);
    glm::dvec2 low(1e9), high(-1e9);
    for (int k = 0; k < 8; ++k) {
        const glm::dvec3 corner((k & 1) ? box.high.x : box.low.x,
                                (k & 2) ? box.high.y : box.low.y,
                                (k & 4) ? box.high.z : box.low.z);
        const auto pixel = project(projector, scan_from_mesh * corner);
        if (!pixel) {
            low = glm::dvec2(0.0);
            high = glm::dvec2(projector.width, projector.height);
            break;
        }
        low = glm::min(low, *pixel);
        high = glm::max(high, *pixel);
    }
    const auto first = [&](double from) {
        return std::max(0, static_cast<int>(from)) / stride * stride + stride / 2;
    };
    PoseEvidence evidence;
    std::vector<TraceRay> rays;
    std::vector<glm::ivec2> pixels;
    for (int y = first(low.y); y < std::min<double>(projector.height, high.y + 1.0); y += stride)
        for (int x = first(low.x); x < std::min<double>(projector.width, high.x + 1.0);
             x += stride) {
            const Ray ray = ray_through(projector, {x + 0.5, y + 0.5});
            TraceRay trace;
            trace.origin = glm::vec3(mesh_from_scan * ray.origin);
            trace.direction = glm::vec3(mesh_from_scan.rotation * ray.direction);
            rays.push_back(trace);
            pixels.emplace_back(x, y);
        }
    std::vector<Hit> hits(rays.size());
    tracer.closest(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid()) continue;
        const SurfacePoint point = surface_point(mesh, hits[i]);
        const glm::dvec3 normal(point.geometric_normal);
        if (glm::dot(normal, glm::dvec3(rays[i].direction)) > -kGrazing) continue;
        const glm::ivec2 p = pixels[i];
        const float* measured = scan.points_mm.pixel(p.x, p.y);
        if (std::isfinite(measured[0])) {
            const glm::dvec3 apart =
                mesh_from_scan * glm::dvec3(measured[0], measured[1], measured[2]) -
                glm::dvec3(rays[i].origin);
            const double behind = glm::length(apart) - static_cast<double>(hits[i].t);
            if (behind < -within_mm) {
                ++evidence.hidden;
                continue;
            }
            if (behind > within_mm) ++evidence.through;
            const bool ruled_out = !ignored.empty() && ignored.at(p.x, p.y);
            if (behind <= within_mm && !ruled_out) ++evidence.agree;
            ++evidence.expected;
        } else {
            const glm::dvec3 place(point.position_mm);
            evidence.expected += std::any_of(sights.begin(), sights.end(), [&](const Sight& sight) {
                return seen_by(sight, tracer, scan_from_mesh, place, normal);
            });
        }
    }
    return evidence;
}

OutlineEvidence outline_of(const Tracer& tracer,
                           const View& projector,
                           const Scan& scan,
                           int stride) {
    const int columns = projector.width / stride, rows = projector.height / stride;
    const auto pixel_of = [&](const glm::ivec2& cell) { return cell * stride + stride / 2; };
    std::vector<TraceRay> rays;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const Ray ray = ray_through(projector, glm::dvec2(pixel_of({x, y})) + 0.5);
            TraceRay trace;
            trace.origin = glm::vec3(ray.origin);
            trace.direction = glm::vec3(ray.direction);
            rays.push_back(trace);
        }
    std::vector<Hit> hits(rays.size());
    tracer.closest(rays, hits);
    const auto is_inside = [&](const glm::ivec2& cell) {
        return cell.x >= 0 && cell.y >= 0 && cell.x < columns && cell.y < rows;
    };
    const auto is_hit = [&](const glm::ivec2& cell) {
        return hits[static_cast<std::size_t>(cell.y * columns + cell.x)].valid();
    };
    OutlineEvidence evidence;
    constexpr int kWays[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x)
            for (const auto& way : kWays) {
                // The border lies between `last` and the cell after it; one more on either side
                // keeps away from what decoding leaves out there.
                const glm::ivec2 last(x, y), step(way[0], way[1]);
                const glm::ivec2 inner = last - step, outer = last + 2 * step;
                if (!is_hit(last) || !is_inside(inner) || !is_inside(outer)) continue;
                if (!is_hit(inner) || is_hit(last + step) || is_hit(outer)) continue;
                const glm::ivec2 from = pixel_of(inner);
                if (!std::isfinite(scan.normals.at(from.x, from.y))) continue;
                ++evidence.looked_at;
                evidence.runs_on += goes_on(scan, from, pixel_of(outer));
            }
    return evidence;
}

}  // namespace livery
