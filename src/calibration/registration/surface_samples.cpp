#include "calibration/registration/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>
#include <nanoflann.hpp>

#include "calibration/registration/rotation.h"
#include "core/random.h"

namespace livery {

namespace {

/// Normals within 15 degrees of the plane's count as on it.
constexpr double kPlaneCosine = 0.966;

/// The cube that a sample lies in and the eighth of all directions that it faces.
std::uint64_t cell_of(const SurfaceSamples& samples, std::size_t i, double spacing_mm) {
    std::uint64_t key = 0;
    for (int c = 0; c < 3; ++c) {
        const auto cell = static_cast<std::int64_t>(std::floor(samples.points[i][c] / spacing_mm));
        key = (key << 20u) | (static_cast<std::uint64_t>(cell + (1 << 19)) & 0xfffffu);
        key = (key << 1u) | (samples.normals[i][c] > 0.0 ? 1u : 0u);
    }
    return key;
}

struct Plane {
    glm::dvec3 normal{0.0};
    double offset = 0.0;
    std::size_t count = 0;
};

bool lies_on(const Plane& plane, const glm::dvec3& point, const glm::dvec3& normal, double within) {
    return std::abs(glm::dot(plane.normal, point) - plane.offset) < within &&
           glm::dot(plane.normal, normal) > kPlaneCosine;
}

/// The plane through one sample and its normal that most of the samples lie on.
Plane best_plane(const SurfaceSamples& samples,
                 const std::vector<std::uint8_t>& taken,
                 double within) {
    Random random(11);
    Plane best;
    for (int attempt = 0; attempt < 300 && samples.size() > 0; ++attempt) {
        const std::uint32_t a = random.below(static_cast<std::uint32_t>(samples.size()));
        if (taken[a]) continue;
        Plane plane{samples.normals[a], 0.0, 0};
        // A second sample on it at a distance makes the normal sharper than one alone has it.
        const std::uint32_t b = random.below(static_cast<std::uint32_t>(samples.size()));
        const glm::dvec3 apart = samples.points[b] - samples.points[a];
        if (!taken[b] && glm::dot(samples.normals[b], plane.normal) > kPlaneCosine &&
            std::abs(glm::dot(apart, plane.normal)) < 0.2 * glm::length(apart)) {
            const glm::dvec3 along = glm::normalize(apart);
            plane.normal = glm::normalize(plane.normal - along * glm::dot(along, plane.normal));
        }
        plane.offset = glm::dot(plane.normal, samples.points[a]);
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (!taken[i] && lies_on(plane, samples.points[i], samples.normals[i], within))
                ++plane.count;
        if (plane.count > best.count) best = plane;
    }
    return best;
}

/// Its extent: squares of the plane that samples on it lie in.
std::size_t cells_of(const Plane& plane,
                     const SurfaceSamples& samples,
                     const std::vector<std::uint8_t>& taken,
                     double spacing_mm) {
    const glm::dmat3 upright = rotation_between(plane.normal, {0.0, 0.0, 1.0});
    std::unordered_set<std::uint64_t> cells;
    for (std::size_t i = 0; i < samples.size() && plane.count > 0; ++i) {
        if (taken[i] || !lies_on(plane, samples.points[i], samples.normals[i], 0.5 * spacing_mm))
            continue;
        const glm::dvec3 place = upright * samples.points[i] / spacing_mm;
        const auto x = static_cast<std::int32_t>(std::floor(place.x));
        const auto y = static_cast<std::int32_t>(std::floor(place.y));
        cells.insert((static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32u) |
                     static_cast<std::uint32_t>(y));
    }
    return cells.size();
}

}  // namespace

SurfaceSamples thinned(const SurfaceSamples& samples, double spacing_mm) {
    SurfaceSamples result;
    std::unordered_set<std::uint64_t> taken;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!taken.insert(cell_of(samples, i, spacing_mm)).second) continue;
        result.points.push_back(samples.points[i]);
        result.normals.push_back(samples.normals[i]);
    }
    return result;
}

SurfaceSamples cell_means(const SurfaceSamples& samples, double spacing_mm) {
    SurfaceSamples sums;
    std::vector<double> counts;
    std::unordered_map<std::uint64_t, std::size_t> places;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto [found, is_new] =
            places.try_emplace(cell_of(samples, i, spacing_mm), sums.size());
        if (is_new) {
            sums.points.emplace_back(0.0);
            sums.normals.emplace_back(0.0);
            counts.push_back(0.0);
        }
        sums.points[found->second] += samples.points[i];
        sums.normals[found->second] += samples.normals[i];
        counts[found->second] += 1.0;
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        sums.points[k] /= counts[k];
        sums.normals[k] = glm::normalize(sums.normals[k]);
    }
    return sums;
}

SurfaceSamples sample_mesh(const Mesh& mesh, const Tracer& tracer, double spacing_mm) {
    std::vector<double> area_to(mesh.triangles.size());
    double area = 0.0;
    const auto corner = [&](std::size_t triangle, int k) {
        return glm::dvec3(mesh.positions_mm[mesh.triangles[triangle][k]]);
    };
    const auto area_vector = [&](std::size_t t) {
        return 0.5 * glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    };
    for (std::size_t t = 0; t < area_to.size(); ++t)
        area_to[t] = area += glm::length(area_vector(t));
    SurfaceSamples dense;
    Random random(7);
    const double wanted = std::min(8.0 * area / (spacing_mm * spacing_mm), 2e6);
    const auto count = static_cast<std::size_t>(wanted);
    for (std::size_t i = 0; i < count; ++i) {
        const double at = area * (static_cast<double>(i) + random.uniform()) / wanted;
        const auto found = std::lower_bound(area_to.begin(), area_to.end(), at);
        const auto t =
            std::min(static_cast<std::size_t>(found - area_to.begin()), area_to.size() - 1);
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const glm::uvec3& at_corner = mesh.triangles[t];
        const glm::dvec3 normal = (1.0 - u - v) * glm::dvec3(mesh.normals[at_corner[0]]) +
                                  u * glm::dvec3(mesh.normals[at_corner[1]]) +
                                  v * glm::dvec3(mesh.normals[at_corner[2]]);
        if (!(glm::length(normal) > 1e-3)) continue;
        dense.points.push_back(corner(t, 0) + u * (corner(t, 1) - corner(t, 0)) +
                               v * (corner(t, 2) - corner(t, 0)));
        dense.normals.push_back(glm::normalize(normal));
    }
    const SurfaceSamples even = thinned(dense, spacing_mm);
    const std::vector<glm::vec3> points(even.points.begin(), even.points.end());
    const std::vector<glm::vec3> normals(even.normals.begin(), even.normals.end());
    const std::vector<float> open = ambient_openness(tracer, points, normals, 16, 1e6f);
    SurfaceSamples result;
    for (std::size_t i = 0; i < even.size(); ++i) {
        if (open[i] < 0.1f) continue;
        result.points.push_back(even.points[i]);
        result.normals.push_back(even.normals[i]);
    }
    return result;
}

SurfaceSamples sample_scan(const Scan& scan, double spacing_mm) {
    SurfaceSamples all;
    for (std::size_t i = 0; i < scan.sigma_mm.values.size(); ++i) {
        const float *p = &scan.points_mm.values[3 * i], *n = &scan.normals.values[3 * i];
        if (!std::isfinite(p[0]) || !std::isfinite(n[0])) continue;
        all.points.emplace_back(p[0], p[1], p[2]);
        all.normals.emplace_back(n[0], n[1], n[2]);
    }
    return thinned(all, spacing_mm);
}

SurfacePlane main_plane(const SurfaceSamples& samples, double spacing_mm) {
    const std::vector<std::uint8_t> none(samples.size(), 0);
    const Plane plane = best_plane(samples, none, 0.3 * spacing_mm);
    // The mean of what lies on it, sharper than the two samples it was made of.
    SurfacePlane result{glm::dvec3(0.0), 0.0};
    double count = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!lies_on(plane, samples.points[i], samples.normals[i], 0.3 * spacing_mm)) continue;
        result.normal += samples.normals[i];
        count += 1.0;
    }
    result.normal = count > 0.0 ? glm::normalize(result.normal) : plane.normal;
    for (std::size_t i = 0; i < samples.size() && count > 0.0; ++i)
        if (lies_on(plane, samples.points[i], samples.normals[i], 0.3 * spacing_mm))
            result.offset += glm::dot(result.normal, samples.points[i]) / count;
    return result;
}

SurfaceSamples beside_plane(const SurfaceSamples& samples,
                            const SurfacePlane& plane,
                            double within_mm) {
    SurfaceSamples rest;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (lies_on(
                {plane.normal, plane.offset, 0}, samples.points[i], samples.normals[i], within_mm))
            continue;
        rest.points.push_back(samples.points[i]);
        rest.normals.push_back(samples.normals[i]);
    }
    return rest;
}

std::size_t largest_plane(const SurfaceSamples& samples, double spacing_mm) {
    const std::vector<std::uint8_t> none(samples.size(), 0);
    return cells_of(best_plane(samples, none, 0.5 * spacing_mm), samples, none, spacing_mm);
}

std::vector<std::uint8_t> on_large_planes(const SurfaceSamples& samples,
                                          double spacing_mm,
                                          std::size_t largest) {
    std::vector<std::uint8_t> taken(samples.size(), 0);
    for (int plane_number = 0; plane_number < 6; ++plane_number) {
        const Plane plane = best_plane(samples, taken, 0.5 * spacing_mm);
        if (cells_of(plane, samples, taken, spacing_mm) <= largest) break;
        for (std::size_t i = 0; i < samples.size(); ++i)
            if (lies_on(plane, samples.points[i], samples.normals[i], 0.6 * spacing_mm))
                taken[i] = 1;
    }
    return taken;
}

namespace {

/// Points as nanoflann asks for them.
struct Points {
    std::vector<glm::dvec3> all;
    std::size_t kdtree_get_point_count() const { return all.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return all[i][static_cast<glm::length_t>(axis)];
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;  // nanoflann finds it
    }
};

/// The nearest so far; none beyond what it begins with.
struct Nearest {
    using DistanceType = double;
    double squared;
    std::optional<std::uint32_t> index;
    double worstDist() const { return squared; }
    bool full() const { return index.has_value(); }
    void sort() const {}
    bool addPoint(double squared_distance, std::uint32_t of) {
        if (squared_distance < squared) {
            squared = squared_distance;
            index = of;
        }
        return true;
    }
};

}  // namespace

struct NearestSample::Tree {
    Points points;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>,
                                        Points,
                                        3,
                                        std::uint32_t>
        index;
    explicit Tree(std::vector<glm::dvec3> of) : points{std::move(of)}, index(3, points) {}
};

NearestSample::NearestSample(std::vector<glm::dvec3> points)
    : tree_(std::make_unique<const Tree>(std::move(points))) {}

NearestSample::~NearestSample() = default;

std::optional<std::uint32_t> NearestSample::of(const glm::dvec3& place, double most_mm) const {
    Nearest nearest{most_mm * most_mm, std::nullopt};
    tree_->index.findNeighbors(nearest, &place.x, {});
    return nearest.index;
}

Aligned closest_points(const SurfaceSamples& mesh,
                       const NearestSample& tree,
                       const SurfaceSamples& scan,
                       const Rigid3& scan_from_mesh,
                       double from_mm,
                       double to_mm,
                       int iterations) {
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    using Vector6 = Eigen::Matrix<double, 6, 1>;
    Rigid3 mesh_from_scan = inverse(scan_from_mesh);
    Aligned result;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        const double share =
            iterations > 1 ? static_cast<double>(iteration) / (iterations - 1) : 1.0;
        const double reach = from_mm * std::pow(to_mm / from_mm, share);
        Matrix6 normal_matrix = Matrix6::Zero();
        Vector6 right = Vector6::Zero();
        double squares = 0.0;
        std::size_t count = 0;
        // Turned about the samples' own middle, rotation and shift hardly mix.
        glm::dvec3 middle(0.0);
        std::vector<std::pair<std::uint32_t, glm::dvec3>> matched;
        for (std::size_t i = 0; i < scan.size(); ++i) {
            const glm::dvec3 place = mesh_from_scan * scan.points[i];
            const auto nearest = tree.of(place, reach);
            if (!nearest) continue;
            const glm::dvec3 facing = mesh_from_scan.rotation * scan.normals[i];
            if (glm::dot(facing, mesh.normals[*nearest]) < 0.5) continue;
            matched.emplace_back(*nearest, place);
            middle += place;
        }
        if (matched.size() < 12) return {scan_from_mesh, 0.0, 0};
        middle /= static_cast<double>(matched.size());
        for (const auto& [nearest, place] : matched) {
            const glm::dvec3& normal = mesh.normals[nearest];
            const double off = glm::dot(normal, mesh.points[nearest] - place);
            const double relative = off / reach;
            if (std::abs(relative) >= 1.0) continue;
            const double weight = std::pow(1.0 - relative * relative, 2.0);
            const glm::dvec3 lever = glm::cross(place - middle, normal);
            Vector6 row;
            row << lever.x, lever.y, lever.z, normal.x, normal.y, normal.z;
            normal_matrix += weight * row * row.transpose();
            right += weight * off * row;
            squares += off * off;
            ++count;
        }
        // What the samples do not hold (the turn of a sphere) stays where it is.
        normal_matrix.diagonal().array() += 1e-6 * normal_matrix.trace();
        const Vector6 step = normal_matrix.ldlt().solve(right);
        if (!step.allFinite()) break;
        const glm::dmat3 turn = rotation_of({step[0], step[1], step[2]});
        const glm::dvec3 shift(step[3], step[4], step[5]);
        mesh_from_scan = Rigid3{turn, middle + shift - turn * middle} * mesh_from_scan;
        result.rms_mm = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
        result.inliers = count;
    }
    result.scan_from_mesh = inverse(mesh_from_scan);
    return result;
}

}  // namespace livery
