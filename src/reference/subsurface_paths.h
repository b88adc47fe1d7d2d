// The paths of a scene through its translucent parts.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material.h"
#include "core/random.h"
#include "reference/light_sampling.h"
#include "reference/projected_light.h"
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

}  // namespace livery
