#include "calibration/registration/symmetry.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "calibration/registration/rotation.h"

namespace livery {

FreeTurns free_turns(const SurfaceSamples& samples, double cell_mm) {
    const SurfaceSamples mesh = cell_means(samples, cell_mm);
    const auto count = static_cast<double>(mesh.size());
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& point : mesh.points) middle += point / count;
    double radius = 0.0;
    for (const glm::dvec3& point : mesh.points) radius += glm::length(point - middle) / count;
    using Matrix6 = Eigen::Matrix<double, 6, 6>;
    Matrix6 slip = Matrix6::Zero();
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const glm::dvec3 normal = mesh.normals[i];
        const glm::dvec3 lever = glm::cross((mesh.points[i] - middle) / radius, normal);
        Eigen::Matrix<double, 6, 1> row;
        row << lever.x, lever.y, lever.z, normal.x, normal.y, normal.z;
        slip += row * row.transpose() / count;
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6> solver(slip);
    FreeTurns free;
    free.through_mm = middle;
    int slipping = 0;
    while (slipping < 6 && solver.eigenvalues()[slipping] < kSlipsFreely * kSlipsFreely) ++slipping;
    if (slipping == 0) return free;
    free.count = slipping >= 3 ? 3 : 1;
    if (free.count == 3) {
        // The point nearest to all normals' lines.
        glm::dmat3 sum(0.0);
        glm::dvec3 right(0.0);
        for (std::size_t i = 0; i < mesh.size(); ++i) {
            const glm::dvec3 normal = mesh.normals[i];
            const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(normal, normal);
            sum += across;
            right += across * mesh.points[i];
        }
        free.through_mm = glm::inverse(sum) * right;
        return free;
    }
    const auto motion = solver.eigenvectors().col(0);
    const glm::dvec3 turn(motion[0], motion[1], motion[2]);
    const glm::dvec3 shift(motion[3], motion[4], motion[5]);
    if (glm::length(turn) < 1e-6) return free;
    free.axis = glm::normalize(turn);
    // Where the motion only turns: x with turn x (x - middle) / radius = -shift.
    if (free.count == 1) free.through_mm += radius * glm::cross(turn, shift) / glm::dot(turn, turn);
    return free;
}

bool maps_onto_itself(const SurfaceSamples& mesh,
                      const NearestSample& tree,
                      const Rigid3& motion,
                      double within_mm) {
    std::size_t off = 0;
    const std::size_t step = std::max<std::size_t>(1, mesh.size() / 1500);
    std::size_t looked_at = 0;
    for (std::size_t i = 0; i < mesh.size(); i += step) {
        ++looked_at;
        off += !tree.of(motion * mesh.points[i], within_mm).has_value();
    }
    return static_cast<double>(off) < 0.01 * static_cast<double>(looked_at);
}

bool same_pose(const Rigid3& a_from_mesh,
               const Rigid3& b_from_mesh,
               const FreeTurns& free,
               const glm::dvec3& middle_mm,
               double angle_rad,
               double shift_mm) {
    const glm::dvec3 through = free.count > 0 ? free.through_mm : middle_mm;
    if (glm::length(a_from_mesh * through - b_from_mesh * through) > shift_mm) return false;
    if (free.count == 3) return true;
    if (free.count == 1) {
        const double cosine =
            glm::dot(a_from_mesh.rotation * free.axis, b_from_mesh.rotation * free.axis);
        return cosine > std::cos(angle_rad);
    }
    return angle_of(glm::transpose(a_from_mesh.rotation) * b_from_mesh.rotation) < angle_rad;
}

}  // namespace livery
