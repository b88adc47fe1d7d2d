#include "calibration/registration/closest_points.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>

#include "calibration/registration/rotation.h"

namespace livery {

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
