// Surfaces as points with normals, evenly spread, the nearest of them, and iterative closest
// points: a guess made exact.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "calibration/scan/scan.h"
#include "mesh/mesh.h"
#include "scene/view.h"
#include "tracing/tracer.h"

namespace livery {

struct SurfaceSamples {
    std::vector<glm::dvec3> points;   ///< millimetres
    std::vector<glm::dvec3> normals;  ///< unit, outside
    std::size_t size() const { return points.size(); }
};

/// Points of the mesh about `spacing_mm` apart; what light from outside does not reach (seats, the
/// inner side of a shell) is left out.
SurfaceSamples sample_mesh(const Mesh& mesh, const Tracer& tracer, double spacing_mm);

/// The scan's points that have a normal, about `spacing_mm` apart.
SurfaceSamples sample_scan(const Scan& scan, double spacing_mm);

/// One sample for each cube of that side and each way of facing.
SurfaceSamples thinned(const SurfaceSamples& samples, double spacing_mm);

/// The mean point and normal of each cube of that side and each way of facing.
SurfaceSamples cell_means(const SurfaceSamples& samples, double spacing_mm);

/// Which samples lie on planes of more than `largest` squares of side `spacing_mm`, which is that
/// of the samples: tables and walls, when no face of the product is so large.
std::vector<std::uint8_t> on_large_planes(const SurfaceSamples& samples,
                                          double spacing_mm,
                                          std::size_t largest);

/// normal . x = offset, with most of the samples on it.
struct SurfacePlane {
    glm::dvec3 normal{0.0, 1.0, 0.0};
    double offset = 0.0;
};
SurfacePlane main_plane(const SurfaceSamples& samples, double spacing_mm);

/// The samples that do not lie on a plane.
SurfaceSamples beside_plane(const SurfaceSamples& samples,
                            const SurfacePlane& plane,
                            double within_mm);

/// Squares of the plane on which most of the samples lie.
std::size_t largest_plane(const SurfaceSamples& samples, double spacing_mm);

/// A k-d tree (Bentley 1975). May be asked by several threads at once.
class NearestSample {
  public:
    explicit NearestSample(std::vector<glm::dvec3> points);
    ~NearestSample();
    /// Its index; nothing where none is within `most_mm`.
    std::optional<std::uint32_t> of(const glm::dvec3& place, double most_mm) const;

  private:
    struct Tree;
    std::unique_ptr<const Tree> tree_;
};

struct Aligned {
    Rigid3 scan_from_mesh;
    double rms_mm = 0.0;      ///< of the inliers' distances from the mesh's planes
    std::size_t inliers = 0;  ///< scan samples
};

/// Point to plane (Chen and Medioni 1992), trimmed: a scan sample counts while its nearest mesh
/// sample is within a reach that shrinks from `from_mm` to `to_mm`, and faces the same way; less
/// the farther off its plane it is (Tukey). `tree` is of mesh.points.
Aligned closest_points(const SurfaceSamples& mesh,
                       const NearestSample& tree,
                       const SurfaceSamples& scan,
                       const Rigid3& scan_from_mesh,
                       double from_mm,
                       double to_mm,
                       int iterations);

}  // namespace livery
