// The light that one path carries from the scene to the eye, also through translucent parts.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "appearance/paint_bsdf.h"
#include "core/random.h"
#include "reference/light_sampling.h"
#include "reference/path_tracer.h"
#include "reference/sobol.h"
#include "reference/subsurface_walk.h"
#include "scene/product.h"
#include "tracing/tracer.h"

namespace livery {

struct TranslucentPart {
    WalkMedium medium;
    std::uint16_t part = 0;
    bool closed = true;                ///< otherwise it lies under a plane wherever light enters
    std::optional<double> sheet_mm{};  ///< how deep an open one is; none: a half space
};
/// None for other paints.
std::optional<TranslucentPart> translucent_part(const Product& product,
                                                const Material& material,
                                                std::size_t part);

/// What a translucent paint's boundary mirrors, and nothing else.
Material boundary_alone(const Material& translucent);

/// How often a path is mirrored by the boundary under that cosine; otherwise it enters.
float chance_of_mirroring(const TranslucentPart& part, float cosine);

struct WalkLamps {
    const std::vector<DiscLight>& discs;
    const ProjectedLight* projected = nullptr;
};

struct SurfaceEntry {
    glm::dvec3 position{0.0}, geometric_normal{0.0}, normal{0.0};
    glm::dvec3 toward_eye{0.0};
};
/// Colours in the working space.
struct WalkedLight {
    glm::dvec3 of_lamps{0.0};  ///< radiance toward the eye
    bool left = false;
    glm::vec3 origin{0.0f}, direction{0.0f};  ///< outside, of light to come
    glm::dvec3 weight{0.0};                   ///< of its radiance
};
/// In by refraction, which leaves out what the boundary mirrors, and out again. What leaves an open
/// part does so at the surface over the point of its plane, or where it entered if there is none;
/// what leaves a sheet on its other side, as far behind that as it is thick. `channel`:
/// walk_inside()'s.
WalkedLight walk_through(const TranslucentPart& part,
                         const Mesh& mesh,
                         const Tracer& tracer,
                         const WalkLamps& lights,
                         const SurfaceEntry& entry,
                         double channel,
                         Random& random);

/// Everything that paths read; immutable while they are traced.
class PathScene {
  public:
    PathScene(const Scene& scene, const ReferenceOptions& options);

    /// Radiance that leaves `point` on the side of its normals toward `wo`.
    glm::vec3 radiance(SurfacePoint point, glm::vec3 wo, const PathNumbers& numbers) const;

    const Tracer& tracer() const { return tracer_; }
    /// What was hit, with its relief, on the side that the ray sees.
    SurfacePoint surface_at(const Hit& hit, const glm::vec3& ray_direction) const;

  private:
    struct Vertex;

    glm::vec3 light_on(const Vertex& vertex,
                       const PathNumbers& numbers,
                       const SobolPoint& at,
                       std::uint32_t bounce) const;
    /// What an escaping direction sampled from the reflectance meets.
    glm::vec3 light_along(const glm::vec3& direction, float reflectance_pdf) const;
    /// What a direction out of a translucent part meets.
    glm::vec3 surroundings_along(const glm::vec3& direction) const;
    /// Into a translucent part and out of it again: false where nothing comes out. `sum` gets what
    /// lamps send through it, times `throughput`.
    bool pass_through(const TranslucentPart& part,
                      const Vertex& vertex,
                      float channel,
                      Random random,
                      glm::vec3& throughput,
                      glm::vec3& sum,
                      TraceRay& out) const;
    /// The paint at a point: artwork's, as often as it covers by a number in [0, 1), else the
    /// part's. `made` keeps one that is only this point's.
    const PaintBsdf& bsdf_at(const SurfacePoint& point, float chance, PaintBsdf& made) const;
    bool open(const Vertex& vertex,
              const glm::vec3& direction,
              float distance_mm = kEndless_mm) const;

    const Mesh& mesh_;
    ReferenceOptions options_;
    Tracer tracer_;
    std::vector<PaintBsdf> bsdfs_;
    std::vector<std::optional<TranslucentPart>> translucent_;  ///< one a part; bsdfs_ mirror alone
    std::vector<PartArtwork> artwork_;
    std::vector<std::optional<PartArtwork>> reliefs_;  ///< one a part
    std::vector<PaintBsdf> artwork_bsdfs_;
    std::vector<DiscLight> lights_;
    EnvironmentSampler environment_;
};

}  // namespace livery
