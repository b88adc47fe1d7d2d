#include "calibration/registration/scan_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "calibration/registration/rotation.h"
#include "core/parallel.h"

namespace livery {

namespace {

constexpr int kAngleBins = 15;  // of 12 degrees
constexpr int kTurnBins = 30;   // of 12 degrees

/// Pairs of one kind that take part: those of a large flat face are as many as all others
/// together, and say little.
constexpr std::size_t kMostAlike = 300;

int angle_bin(const glm::dvec3& a, const glm::dvec3& b) {
    const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
    return std::min(static_cast<int>(angle / std::numbers::pi * kAngleBins), kAngleBins - 1);
}

struct PairKinds {
    int distances = 0;
    double spacing_mm = 1.0;

    std::size_t count() const {
        return static_cast<std::size_t>(distances) * kAngleBins * kAngleBins * kAngleBins;
    }
    /// -1: longer than any pair of the mesh, or too short to have a direction.
    std::ptrdiff_t of(const SurfaceSamples& samples, std::size_t a, std::size_t b) const {
        const glm::dvec3 apart = samples.points[b] - samples.points[a];
        const double distance = glm::length(apart);
        const int far = static_cast<int>(distance / spacing_mm);
        if (far < 1 || far >= distances) return -1;
        const glm::dvec3 along = apart / distance;
        std::ptrdiff_t kind = far;
        kind = kind * kAngleBins + angle_bin(samples.normals[a], along);
        kind = kind * kAngleBins + angle_bin(samples.normals[b], along);
        return kind * kAngleBins + angle_bin(samples.normals[a], samples.normals[b]);
    }
};

/// The frame of a sample: its point in the origin, its normal along x.
Rigid3 frame_of(const SurfaceSamples& samples, std::size_t at) {
    const glm::dmat3 rotation = rotation_between(samples.normals[at], {1.0, 0.0, 0.0});
    return {rotation, -(rotation * samples.points[at])};
}

double turn_of(const Rigid3& frame, const glm::dvec3& point) {
    const glm::dvec3 x = frame * point;
    return std::atan2(x.z, x.y);
}

struct MeshPair {
    std::uint32_t from = 0;
    float turn = 0.0f;
};

struct MeshPairs {
    PairKinds kinds;
    std::vector<std::uint32_t> begin;  ///< one a kind, and the end
    std::vector<MeshPair> pairs;
};

MeshPairs pairs_of(const SurfaceSamples& mesh, double spacing_mm) {
    MeshPairs result;
    Bounds box{glm::dvec3(1e300), glm::dvec3(-1e300)};
    for (const glm::dvec3& point : mesh.points) {
        box.low = glm::min(box.low, point);
        box.high = glm::max(box.high, point);
    }
    result.kinds = {static_cast<int>(glm::length(box.high - box.low) / spacing_mm) + 1, spacing_mm};
    std::vector<std::vector<MeshPair>> by_kind(result.kinds.count());
    for (std::uint32_t a = 0; a < mesh.size(); ++a) {
        const Rigid3 frame = frame_of(mesh, a);
        for (std::uint32_t b = 0; b < mesh.size(); ++b) {
            const std::ptrdiff_t kind = a == b ? -1 : result.kinds.of(mesh, a, b);
            if (kind < 0) continue;
            by_kind[static_cast<std::size_t>(kind)].push_back(
                {a, static_cast<float>(turn_of(frame, mesh.points[b]))});
        }
    }
    result.begin.push_back(0);
    for (const auto& alike : by_kind) {
        const std::size_t step = (alike.size() + kMostAlike - 1) / kMostAlike;
        for (std::size_t i = 0; i < alike.size(); i += std::max<std::size_t>(step, 1))
            result.pairs.push_back(alike[i]);
        result.begin.push_back(static_cast<std::uint32_t>(result.pairs.size()));
    }
    return result;
}

/// The poses that most pairs from one scan sample agree on.
void vote(const MeshPairs& model,
          const SurfaceSamples& mesh,
          const SurfaceSamples& scan,
          std::size_t reference,
          std::vector<float>& ballot,
          std::vector<PoseGuess>& guesses) {
    std::fill(ballot.begin(), ballot.end(), 0.0f);
    const Rigid3 frame = frame_of(scan, reference);
    for (std::size_t other = 0; other < scan.size(); ++other) {
        const std::ptrdiff_t kind =
            other == reference ? -1 : model.kinds.of(scan, reference, other);
        if (kind < 0) continue;
        const double turn = turn_of(frame, scan.points[other]);
        const auto at = static_cast<std::size_t>(kind);
        for (std::uint32_t k = model.begin[at]; k < model.begin[at + 1]; ++k) {
            const MeshPair& pair = model.pairs[k];
            double share = (turn - static_cast<double>(pair.turn)) / (2.0 * std::numbers::pi);
            share -= std::floor(share);
            const auto bin = static_cast<std::size_t>(share * kTurnBins) % kTurnBins;
            ballot[pair.from * kTurnBins + bin] += 1.0f;
        }
    }
    constexpr int kPeaks = 3;
    for (int peak = 0; peak < kPeaks; ++peak) {
        const auto best = std::max_element(ballot.begin(), ballot.end());
        if (*best < 3.0f) return;
        const auto at = static_cast<std::size_t>(best - ballot.begin());
        const double turn =
            (static_cast<double>(at % kTurnBins) + 0.5) / kTurnBins * 2.0 * std::numbers::pi;
        const Rigid3 turned{rotation_of({turn, 0.0, 0.0}), glm::dvec3(0.0)};
        guesses.push_back(
            {inverse(frame) * turned * frame_of(mesh, at / kTurnBins), static_cast<double>(*best)});
        *best = 0.0f;
    }
}

}  // namespace

std::vector<PoseGuess> poses_by_pairs(const SurfaceSamples& mesh,
                                      const SurfaceSamples& scan,
                                      double spacing_mm,
                                      std::size_t most) {
    if (mesh.size() < 3 || scan.size() < 3) return {};
    const MeshPairs model = pairs_of(mesh, spacing_mm);
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& point : mesh.points) middle += point / static_cast<double>(mesh.size());

    const std::size_t step = std::max<std::size_t>(1, scan.size() / 300);
    std::vector<std::vector<PoseGuess>> by_reference(scan.size() / step);
    parallel_for(by_reference.size(), 4, [&](std::size_t begin, std::size_t end) {
        std::vector<float> ballot(mesh.size() * kTurnBins);
        for (std::size_t i = begin; i < end; ++i)
            vote(model, mesh, scan, i * step, ballot, by_reference[i]);
    });
    std::vector<PoseGuess> guesses;
    for (const auto& some : by_reference) guesses.insert(guesses.end(), some.begin(), some.end());
    const auto more_votes = [](const PoseGuess& a, const PoseGuess& b) {
        return a.votes > b.votes;
    };
    std::stable_sort(guesses.begin(), guesses.end(), more_votes);

    std::vector<PoseGuess> distinct;
    for (const PoseGuess& guess : guesses) {
        const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const PoseGuess& one) {
            const glm::dvec3 apart = one.scan_from_mesh * middle - guess.scan_from_mesh * middle;
            return glm::length(apart) < 3.0 * spacing_mm &&
                   angle_of(glm::transpose(one.scan_from_mesh.rotation) *
                            guess.scan_from_mesh.rotation) < 15.0 * std::numbers::pi / 180.0;
        });
        if (same == distinct.end()) {
            distinct.push_back(guess);
        } else {
            same->votes += guess.votes;
        }
    }
    std::stable_sort(distinct.begin(), distinct.end(), more_votes);
    if (distinct.size() > most) distinct.resize(most);
    return distinct;
}

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
