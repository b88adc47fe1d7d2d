#include "scene/effects.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "appearance/subsurface/subsurface_profile.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/error.h"

namespace livery {

namespace {

constexpr double kShare = 0.9;

/// In mean free paths: all that a half space's profile depends on is its albedo, g and index.
double reach_in_paths(const ScatteringMedium& medium) {
    const std::array<double, 3> key{medium.albedo_prime(), medium.g, medium.eta};
    static std::mutex mutex;
    static std::map<std::array<double, 3>, double> known;
    const std::lock_guard lock(mutex);
    if (const auto found = known.find(key); found != known.end()) return found->second;
    constexpr std::size_t kMost = 4096;
    if (known.size() >= kMost) known.clear();
    const SubsurfaceProfile profile =
        subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium);
    return known[key] = energy_radius_mm(profile, medium, kShare) / medium.mean_free_path_mm();
}

}  // namespace

double subsurface_reach_mm(const Material& paint, double product_scale) {
    if (!is_translucent(paint)) return 0.0;
    const glm::dvec3 albedo = entering_albedo(*paint.medium);
    double reach = 0.0;
    for (int c = 0; c < 3; ++c) {
        if (albedo[c] < kUnseenAlbedo) continue;
        ScatteringMedium medium = medium_of(*paint.medium, c);
        medium.thickness_mm.reset();
        reach = std::max(reach, reach_in_paths(medium) * medium.mean_free_path_mm());
    }
    return reach / product_scale;
}

bool light_spreads(const Material& paint, double product_scale) {
    return subsurface_reach_mm(paint, product_scale) > kUnseenReach_mm;
}

std::optional<std::size_t> spreading_part(const Scene& scene) {
    std::optional<std::size_t> farthest;
    double reach = kUnseenReach_mm;
    for (std::size_t p = 0; p < scene.part_materials.size(); ++p) {
        const double own =
            subsurface_reach_mm(scene.part_materials[p], scene.product->product_scale);
        if (own <= reach) continue;
        farthest = p;
        reach = own;
    }
    return farthest;
}

namespace {

constexpr std::array kQualities{Quality::draft, Quality::normal, Quality::high, Quality::reference};

bool is_lit(const Scene& scene) {
    return std::any_of(scene.lights.begin(), scene.lights.end(), [](const DirectionalLight& light) {
        return light.radiance_rec709 != glm::dvec3(0.0);
    });
}

bool has_environment(const Scene& scene) {
    return scene.environment && !scene.environment->radiance_working.empty() &&
           scene.environment->scale != 0.0;
}

bool has_light(const Scene& scene) { return is_lit(scene) || has_environment(scene); }

bool mirrors_light(const Scene& scene) {
    return has_light(scene) && any_paint(scene, [](const Material& material) {
               return model_info(material.model).mirrors();
           });
}

bool always(const Scene&) { return true; }

bool glints_in_light(const Scene& scene) { return is_lit(scene) && any_paint(scene, has_glints); }

bool wears_film(const Scene& scene) { return any_paint(scene, has_film); }

bool has_relief(const Scene& scene) { return !scene.relief.empty(); }

bool light_spreads_in_parts(const Scene& scene) {
    return has_light(scene) && spreading_part(scene).has_value();
}

}  // namespace

const std::vector<EffectInfo>& effect_table() {
    static const std::vector<EffectInfo> table{
        {.effect = Effect::sub_samples,
         .name = "sub-samples",
         .in_words = "what a projector pixel covers",
         .levels = {{"4", "edges and bends by 4 rays a pixel"},
                    {"16", "edges and bends by 16 rays a pixel"},
                    {"64", "edges and bends by 64 rays a pixel"}},
         .at = {.draft = 0, .normal = 1, .high = 1},
         .called_for = always},
        {.effect = Effect::shadows,
         .name = "shadows",
         .in_words = "parts hide lights from one another",
         .levels = {{"none", "lights shine through parts"},
                    {"sharp", "one ray a fragment: shadows without a penumbra"},
                    {"16 rays", "soft shadows by 16 rays a fragment"},
                    {"64 rays", "soft shadows by 64 rays a fragment"}},
         .at = {.draft = 1, .normal = 2, .high = 3},
         .called_for = is_lit},
        {.effect = Effect::environment,
         .name = "environment",
         .in_words = "light from all around",
         .levels = {{"none", "lamps alone"},
                    {"filtered", "the environment, filtered for each lobe"}},
         .at = {.draft = 1, .normal = 1, .high = 1},
         .called_for = has_environment},
        {.effect = Effect::occlusion,
         .name = "occlusion",
         .in_words = "parts hide the environment from one another",
         .levels = {{"none", "the environment reaches every point"},
                    {"joints", "8 directions at edges and in joints"},
                    {"16 rays", "16 directions, 128 where little of the sky is left"},
                    {"64 rays", "64 directions, 256 where little of the sky is left"}},
         .at = {.draft = 1, .normal = 2, .high = 3},
         .called_for = has_environment},
        {.effect = Effect::mirrored_environment,
         .name = "mirrored-environment",
         .in_words = "what glossy parts mirror of the environment",
         .levels = {{"look-up", "the environment blurred for each lobe, looked up once"},
                    {"56 nodes", "14 rings of 4 nodes, one normal a pixel"},
                    {"320 nodes", "20 rings of 16 nodes around four normals a pixel"},
                    {"744 nodes", "31 rings of 24 nodes around four normals a pixel"}},
         .at = {.draft = 0, .normal = 2, .high = 3},
         .called_for = mirrors_light},
        {.effect = Effect::reflected_occlusion,
         .name = "reflected-occlusion",
         .in_words = "parts hide the environment that others mirror",
         .levels = {{"none", "the environment is mirrored through parts"},
                    {"rays", "an eighth of the nodes' rays a fragment"}},
         .at = {.draft = 0, .normal = 1, .high = 1},
         .called_for = mirrors_light},
        {.effect = Effect::interreflection,
         .name = "interreflection",
         .in_words = "parts light one another",
         .levels = {{"none", "parts send no light to one another"},
                    {"one bounce", "light that one part sent to the next, at the vertices"},
                    {"all bounces", "light that parts send to and fro, at the vertices"}},
         .at = {.draft = 0, .normal = 1, .high = 1},
         .called_for = has_light},
        {.effect = Effect::glints,
         .name = "glints",
         .in_words = "single flakes",
         .levels = {{"none", "flakes as a smooth lobe"},
                    {"counted", "flakes counted in each pixel"}},
         .at = {.draft = 1, .normal = 1, .high = 1},
         .called_for = glints_in_light},
        {.effect = Effect::film,
         .name = "film",
         .in_words = "thin films on flakes",
         .levels = {{"none", "flakes without their film"},
                    {"interference", "the colours of thin films"}},
         .at = {.draft = 1, .normal = 1, .high = 1},
         .called_for = wears_film},
        {.effect = Effect::relief,
         .name = "relief",
         .in_words = "pictures of normals",
         .levels = {{"none", "the surface as the mesh has it"},
                    {"tilted", "fragments tilted by the relief"}},
         .at = {.draft = 1, .normal = 1, .high = 1},
         .called_for = has_relief},
        {.effect = Effect::subsurface,
         .name = "subsurface",
         .in_words = "light goes through translucent parts",
         .levels = {{"none", "light leaves translucent parts where it entered"},
                    {"gather", "light leaves around where it entered, from coarse nodes"},
                    {"transport", "the same from fine nodes, where no air lies between"}},
         .at = {.draft = 0, .normal = 1, .high = 2},
         .called_for = light_spreads_in_parts},
    };
    return table;
}

const EffectInfo& effect_info(Effect effect) {
    return effect_table().at(static_cast<std::size_t>(effect));
}

Quality parse_quality(const std::string& text) {
    for (const Quality quality : kQualities) {
        if (to_string(quality) == text) return quality;
    }
    throw std::invalid_argument(
        fmt::format("quality \"{}\" is not one of draft, normal, high, reference", text));
}

std::string to_string(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return "draft";
        case Quality::normal:
            return "normal";
        case Quality::high:
            return "high";
        case Quality::reference:
            return "reference";
    }
    throw std::invalid_argument(
        fmt::format("quality {} does not exist", static_cast<int>(quality)));
}

EffectLevels levels_of(Quality quality) {
    check_argument(quality != Quality::reference, "the reference level is the path tracer's");
    EffectLevels levels;
    for (const EffectInfo& info : effect_table()) {
        levels[info.effect] = quality == Quality::draft    ? info.at.draft
                              : quality == Quality::normal ? info.at.normal
                                                           : info.at.high;
    }
    return levels;
}

EffectLevels dearest_levels() {
    EffectLevels levels;
    for (const EffectInfo& info : effect_table()) {
        levels[info.effect] = static_cast<int>(info.levels.size()) - 1;
    }
    return levels;
}

Quality nearest_quality(const EffectLevels& levels) {
    for (const Quality quality : {Quality::high, Quality::normal}) {
        const EffectLevels least = levels_of(quality);
        if (std::equal(least.of.begin(), least.of.end(), levels.of.begin(), std::less_equal<>())) {
            return quality;
        }
    }
    return Quality::draft;
}

void check_levels(const EffectLevels& levels) {
    for (const EffectInfo& info : effect_table()) {
        const int level = levels[info.effect];
        check_argument(
            level >= 0 && level < static_cast<int>(info.levels.size()),
            fmt::format("level {} of {}, which has {}", level, info.name, info.levels.size()));
    }
}

EffectLevels parse_levels(const std::string& text, EffectLevels levels) {
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) {
        const std::size_t sign = word.find('=');
        const std::string effect = word.substr(0, sign);
        const std::string level = sign == std::string::npos ? "" : word.substr(sign + 1);
        const auto info = std::find_if(effect_table().begin(),
                                       effect_table().end(),
                                       [&](const EffectInfo& one) { return effect == one.name; });
        if (info == effect_table().end()) {
            std::string names;
            for (const EffectInfo& one : effect_table()) names += std::string(" ") + one.name;
            throw std::invalid_argument(
                fmt::format("found no effect \"{}\", expected one of{}", effect, names));
        }
        const auto found = std::find_if(info->levels.begin(),
                                        info->levels.end(),
                                        [&](const EffectLevel& one) { return level == one.name; });
        if (found == info->levels.end()) {
            std::string names;
            for (const EffectLevel& one : info->levels) {
                names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", one.name);
            }
            throw std::invalid_argument(fmt::format(
                "found no level \"{}\" of {}, expected one of {}", level, effect, names));
        }
        levels[info->effect] = static_cast<int>(found - info->levels.begin());
    }
    return levels;
}

std::string to_string(const EffectLevels& levels) {
    std::string text;
    for (const EffectInfo& info : effect_table()) {
        text += fmt::format("{}{}={}",
                            text.empty() ? "" : ",",
                            info.name,
                            info.levels.at(static_cast<std::size_t>(levels[info.effect])).name);
    }
    return text;
}

bool calls_for(const Scene& scene, Effect effect) { return effect_info(effect).called_for(scene); }

Scene at_levels(const Scene& scene, const EffectLevels& levels) {
    Scene result = scene;
    if (levels[Effect::environment] == 0) result.environment = nullptr;
    if (levels[Effect::relief] == 0) result.relief.clear();
    const auto change = [&](Material& material) {
        if (levels[Effect::glints] == 0) material.glint_density_per_mm2 = 0.0;
        if (levels[Effect::film] == 0) material.film_nm = 0.0;
    };
    const double scale = scene.product ? scene.product->product_scale : 1.0;
    for (Material& material : result.part_materials) {
        change(material);
        const bool spread = levels[Effect::subsurface] > 0 && light_spreads(material, scale);
        if (!spread) material = albedo_paint(std::move(material));
    }
    for (PartArtwork& artwork : result.artwork) {
        change(artwork.material);
        // As thin as paint: its light comes out where it went in
        artwork.material = albedo_paint(std::move(artwork.material));
    }
    return result;
}

}  // namespace livery
