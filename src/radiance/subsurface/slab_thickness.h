// Where a part is so thin and flat that light goes through it as through a slab.
#pragma once

#include <cstddef>
#include <optional>

#include <glm/vec3.hpp>

#include "tracing/tracer.h"

namespace livery {

/// How thick a part is under a point of its surface, by rays inward: none where it is thicker than
/// `most_mm`, where something else stands in it, where its other side is not about parallel, and
/// where slanting rays go as in a ball and not farther than the straight one.
std::optional<float> slab_thickness_mm(const Tracer& tracer,
                                       const Mesh& product,
                                       std::size_t part,
                                       const glm::vec3& position_mm,
                                       const glm::vec3& normal,
                                       float most_mm);

/// The thickest place of a part that is a sheet all over, but for rims of a fifth of its surface;
/// none of others.
std::optional<float> sheet_thickness_mm(const Tracer& tracer,
                                        const Mesh& product,
                                        std::size_t part,
                                        float most_mm);

/// A tenth of the part's surface that is a slab is thinner than that; none where a twentieth of it
/// or less is one.
std::optional<float> thinnest_slab_mm(const Tracer& tracer,
                                      const Mesh& product,
                                      std::size_t part,
                                      float most_mm);

}  // namespace livery
