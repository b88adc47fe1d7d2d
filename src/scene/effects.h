// How far light goes in the translucent parts of a scene.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

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

enum class Effect {
    sub_samples,           ///< rays a pixel of the surface map
    shadows,               ///< of the lights, sharp or soft
    environment,           ///< light from all around
    occlusion,             ///< of that light, by the product
    mirrored_environment,  ///< nodes of mirror lobes
    reflected_occlusion,   ///< of mirrored light, by the product
    interreflection,       ///< light that parts send to one another
    glints,                ///< single flakes
    film,                  ///< thin films on flakes
    relief,                ///< pictures of normals
    subsurface,            ///< light that leaves translucent parts beside where it entered
};
inline constexpr std::size_t kEffects = 11;

struct EffectLevel {
    const char* name;      ///< in tables, "16 rays"
    const char* in_words;  ///< what is seen at it
};
/// Levels that go by a quality's name.
struct QualityLevels {
    int draft = 0, normal = 0, high = 0;
};
struct EffectInfo {
    Effect effect;
    const char* name;                 ///< in JSON and tables, "reflected-occlusion"
    const char* in_words;             ///< "parts hide the mirrored environment"
    std::vector<EffectLevel> levels;  ///< rising in cost; the first is none of it where that can be
    QualityLevels at;
    bool (*called_for)(const Scene& scene);  ///< whether a scene has anything for it to act on
};
/// In the order of Effect.
const std::vector<EffectInfo>& effect_table();
const EffectInfo& effect_info(Effect effect);

/// The first level of Effect::mirrored_environment whose lobes know what hides them; those before
/// are of a scene whose parts are mirrored through.
inline constexpr int kMirrorsWithRays = 2;

/// An index into the levels of each effect.
struct EffectLevels {
    std::array<int, kEffects> of{};

    int operator[](Effect effect) const { return of[static_cast<std::size_t>(effect)]; }
    int& operator[](Effect effect) { return of[static_cast<std::size_t>(effect)]; }
    auto operator<=>(const EffectLevels&) const = default;
};

/// Named sets of levels; `reference` is the path tracer.
enum class Quality { draft, normal, high, reference };
Quality parse_quality(const std::string& text);  ///< throws std::invalid_argument with the names
std::string to_string(Quality quality);

/// Throws std::invalid_argument for the path tracer's.
EffectLevels levels_of(Quality quality);
/// The last level of each effect.
EffectLevels dearest_levels();
/// The dearest quality that spends on no effect more than these do; draft where none does.
Quality nearest_quality(const EffectLevels& levels);
/// Throws std::invalid_argument for a level that its effect does not have.
void check_levels(const EffectLevels& levels);

/// "shadows=sharp,interreflection=none": `levels` with those instead. Throws std::invalid_argument
/// that lists the names there are.
EffectLevels parse_levels(const std::string& text, EffectLevels levels);
/// What parse_levels() reads: all of them.
std::string to_string(const EffectLevels& levels);

/// Whether a scene has anything for the effect to act on.
bool calls_for(const Scene& scene, Effect effect);

/// The scene without what its levels leave out of it: environment, glints, films, relief, and how
/// far light goes in translucent parts, which wear their albedo then (albedo_paint()).
Scene at_levels(const Scene& scene, const EffectLevels& levels);

}  // namespace livery
