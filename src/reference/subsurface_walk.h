// Light in a translucent medium, found by a random walk from the eye's side, and the boundary of a
// part as walks in it meet it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "appearance/subsurface/translucent_material.h"
#include "core/random.h"
#include "tracing/tracer.h"

namespace livery {

/// Per millimetre of the mesh, in linear Rec.709 channels.
struct WalkMedium {
    glm::dvec3 sigma_a{0.0}, sigma_s{0.0}, sigma_t{0.0};
    double g = 0.0, eta = 1.5;
};
WalkMedium walk_medium(const TranslucentMaterial& on_mock_up);

/// Where a ray inside meets the boundary. Normals are unit and on the outside.
struct BoundaryPoint {
    glm::dvec3 position{0.0}, geometric_normal{0.0, 0.0, 1.0}, normal{0.0, 0.0, 1.0};
    /// How `normal` changes with the position on the surface: d normal = change * d position.
    glm::dmat3 change{0.0};
    double distance = 0.0;
    bool lets_out = true;  ///< otherwise whatever stands there takes all light
};

/// Of one body; for many threads.
class Boundary {
  public:
    virtual ~Boundary() = default;
    /// The first point along the ray within `farthest`, or none.
    virtual std::optional<BoundaryPoint> first(const glm::dvec3& origin,
                                               const glm::dvec3& direction,
                                               double farthest) const = 0;
    /// An origin for rays inside, of a point on the boundary.
    virtual glm::dvec3 inside_of(const BoundaryPoint& at) const = 0;
};

/// Light from one direction, at every point around alike: a projector's, too, a few millimetres
/// under the surface.
struct ArrivingLight {
    glm::dvec3 direction{0.0, 0.0, 1.0};  ///< toward it
    glm::dvec3 irradiance{0.0};           ///< on a plane that faces it, of lamps
    bool projected = false;               ///< otherwise as the picture has it where it enters
};

struct WalkLights {
    /// A direction of each light to try at a scattering there.
    std::function<void(
        const glm::dvec3& point, Random&, const std::function<void(const ArrivingLight&)>&)>
        each;
    /// What reaches the boundary there, on a plane that faces it; 0 where something hides it.
    std::function<glm::dvec3(const BoundaryPoint&, const ArrivingLight&)> reaching;
};

/// What became of a walk. Colours multiply light as a reflectance in linear Rec.709 does.
struct WalkResult {
    bool left = false;  ///< through the boundary; otherwise it was absorbed
    BoundaryPoint at{};
    glm::dvec3 direction{0.0};  ///< outside
    glm::dvec3 weight{0.0};     ///< of radiance that comes from there
};

/// From `origin` inside along `direction`. What leaves by itself is the result; `add` receives what
/// is scattered of each of the lights, as weight (times irradiance it is radiance inside against
/// `direction`) and irradiance: lights without a size are found through the boundary by Newton-like
/// steps toward the refracted ray (Walter, Zhao, Holzschuch and Bala 2009), focused as the normals
/// around say. Distances are sampled for one channel, and weighed for all by the balance heuristic
/// (Wilkie, Nawaz, Droske, Weidlich and Hanika 2014). `channel`, uniform in [0, 1), says which: a
/// walk is nearly all of that colour, and a pixel's are best shared out evenly. `lights` may be
/// null. Never more than a hundred thousand scatterings.
WalkResult walk_inside(
    const WalkMedium& medium,
    const Boundary& boundary,
    glm::dvec3 origin,
    glm::dvec3 direction,
    double channel,
    const WalkLights* lights,
    const std::function<void(const glm::dvec3& weight, const glm::dvec3& irradiance)>& add,
    Random& random);

/// Snell's law: of a ray along `direction` that meets a boundary of `normal` (against it) into a
/// medium of index `eta` over the first; none beyond the critical angle.
std::optional<glm::dvec3> refracted(const glm::dvec3& direction,
                                    const glm::dvec3& normal,
                                    double eta);

/// Of a part that is closed: its triangles, from inside. What else stands in there takes all light.
class PartBoundary final : public Boundary {
  public:
    PartBoundary(const Mesh& mesh, const Tracer& tracer, std::uint16_t part)
        : mesh_(mesh), tracer_(tracer), part_(part) {}
    std::optional<BoundaryPoint> first(const glm::dvec3& origin,
                                       const glm::dvec3& direction,
                                       double farthest) const override;
    glm::dvec3 inside_of(const BoundaryPoint& at) const override;

  private:
    const Mesh& mesh_;
    const Tracer& tracer_;
    std::uint16_t part_;
};

/// Of a part that is open, and so has no inside: what lies under the plane that touches it where
/// light enters, a sheet of that thickness or a half space.
class PlaneBoundary final : public Boundary {
  public:
    PlaneBoundary(const glm::dvec3& point,
                  const glm::dvec3& normal,
                  std::optional<double> thickness_mm = {})
        : point_(point), normal_(normal), thickness_mm_(thickness_mm) {}
    std::optional<BoundaryPoint> first(const glm::dvec3& origin,
                                       const glm::dvec3& direction,
                                       double farthest) const override;
    glm::dvec3 inside_of(const BoundaryPoint& at) const override;

  private:
    glm::dvec3 point_, normal_;
    std::optional<double> thickness_mm_;
};

}  // namespace livery
