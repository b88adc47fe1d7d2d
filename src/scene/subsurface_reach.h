// How far light goes in the translucent parts of a scene.
#pragma once

#include <cstddef>
#include <optional>

#include "scene/scene.h"

namespace livery {

/// Below this on the mock-up, a small part of what a projector's pixel covers, nobody sees that
/// light goes anywhere.
inline constexpr double kUnseenReach_mm = 0.3;

/// Nor does anybody see where less than that share of the light leaves, as of juices and drinks:
/// CIEDE2000 0.25 from black under light that makes white of a diffuser.
inline constexpr double kUnseenAlbedo = 5e-4;

/// Of the channel that light goes farthest in: the distance on the mock-up within which nine tenths
/// of what enters along the normal leaves again, by the best profile (subsurface_profile.h). 0 for
/// other paints, and where less than kUnseenAlbedo does. Worked out once for each medium.
double subsurface_reach_mm(const Material& paint, double product_scale);

/// Whether the paint is translucent and that is seen.
bool light_spreads(const Material& paint, double product_scale);

/// The part in which light goes farthest, as far as any spreads.
std::optional<std::size_t> spreading_part(const Scene& scene);

}  // namespace livery
