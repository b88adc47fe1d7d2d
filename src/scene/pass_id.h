// Which pass of a frame: a value that plans, renderers, costs and panels compare.
#pragma once

#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "appearance/material.h"

namespace livery {

/// In the order in which a plan lists them.
enum class PassKind {
    path_tracer,
    surface_map,
    relief,
    light_visibility,
    environment_irradiance,
    ambient_occlusion,
    interreflection,
    subsurface,
    environment_filter,
    reflection_occlusion,
    mirrored_environment,
    directions,
    diffuse_light,
    artwork,
    glint_places,
    shade,
    resolve,
    compensation,
    prepare,  ///< for a paint that may be next, ahead of its frame
};

struct PassId {
    PassKind kind = PassKind::surface_map;
    std::string part;                       ///< that is shaded; empty: any
    std::optional<ReflectanceModel> model;  ///< that shades, or is prepared
    bool glints = false;                    ///< and single flakes
    std::optional<std::size_t> artwork;     ///< of the scene, that is shaded over the part
    std::optional<std::size_t> light;       ///< of the scene, that is seen; none: any
    std::optional<PassKind> ahead;          ///< that is prepared: more of it than the frame reads

    /// A kind stands for its pass where it has but one.
    PassId(PassKind its_kind = PassKind::surface_map,
           std::string its_part = "",
           std::optional<ReflectanceModel> its_model = std::nullopt,
           bool its_glints = false)
        : kind(its_kind), part(std::move(its_part)), model(its_model), glints(its_glints) {}
    auto operator<=>(const PassId&) const = default;
};

/// For people and in JSON: "surface-map", "key-visibility", "shade:body:car-paint+glints",
/// "shade:body:artwork-1:clearcoat", "prepare:ggx", "prepare:mirrored-environment".
std::string to_string(const PassId& pass);
std::string light_name(std::size_t light);  ///< key, fill, light-3, ...

}  // namespace livery
