#include "scene/effects.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/error.h"
#include "scene/subsurface_reach.h"

namespace livery {

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

bool mirrors(const Material& material) { return model_info(material.model).mirrors(); }

}  // namespace

const std::vector<EffectInfo>& effect_table() {
    static const std::vector<EffectInfo> table{
        {Effect::sub_samples,
         "sub-samples",
         "what a projector pixel covers",
         {{"4", "edges and bends by 4 rays a pixel"},
          {"16", "edges and bends by 16 rays a pixel"},
          {"64", "edges and bends by 64 rays a pixel"}}},
        {Effect::shadows,
         "shadows",
         "parts hide lights from one another",
         {{"none", "lights shine through parts"},
          {"sharp", "one ray a fragment: shadows without a penumbra"},
          {"16 rays", "soft shadows by 16 rays a fragment"},
          {"64 rays", "soft shadows by 64 rays a fragment"}}},
        {Effect::environment,
         "environment",
         "light from all around",
         {{"none", "lamps alone"}, {"filtered", "the environment, filtered for each lobe"}}},
        {Effect::occlusion,
         "occlusion",
         "parts hide the environment from one another",
         {{"none", "the environment reaches every point"},
          {"joints", "8 directions at edges and in joints"},
          {"16 rays", "16 directions, 128 where little of the sky is left"},
          {"64 rays", "64 directions, 256 where little of the sky is left"}}},
        {Effect::mirrored_environment,
         "mirrored-environment",
         "what glossy parts mirror of the environment",
         {{"look-up", "the environment blurred for each lobe, looked up once"},
          {"56 nodes", "14 rings of 4 nodes, one normal a pixel"},
          {"320 nodes", "20 rings of 16 nodes around four normals a pixel"},
          {"744 nodes", "31 rings of 24 nodes around four normals a pixel"}}},
        {Effect::reflected_occlusion,
         "reflected-occlusion",
         "parts hide the environment that others mirror",
         {{"none", "the environment is mirrored through parts"},
          {"rays", "an eighth of the nodes' rays a fragment"}}},
        {Effect::interreflection,
         "interreflection",
         "parts light one another",
         {{"none", "parts send no light to one another"},
          {"one bounce", "light that one part sent to the next, at the vertices"},
          {"all bounces", "light that parts send to and fro, at the vertices"}}},
        {Effect::glints,
         "glints",
         "single flakes",
         {{"none", "flakes as a smooth lobe"}, {"counted", "flakes counted in each pixel"}}},
        {Effect::film,
         "film",
         "thin films on flakes",
         {{"none", "flakes without their film"}, {"interference", "the colours of thin films"}}},
        {Effect::relief,
         "relief",
         "pictures of normals",
         {{"none", "the surface as the mesh has it"},
          {"tilted", "fragments tilted by the relief"}}},
        {Effect::subsurface,
         "subsurface",
         "light goes through translucent parts",
         {{"none", "light leaves translucent parts where it entered"},
          {"gather", "light leaves around where it entered, from coarse nodes"},
          {"transport", "the same from fine nodes, where no air lies between"}}},
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
    switch (quality) {
        case Quality::draft:
            return {{0, 1, 1, 1, 0, 0, 0, 1, 1, 1, 0}};
        case Quality::normal:
            return {{1, 2, 1, 2, 2, 1, 1, 1, 1, 1, 1}};
        case Quality::high:
            return {{1, 3, 1, 3, 3, 1, 1, 1, 1, 1, 2}};
        case Quality::reference:
            break;
    }
    throw std::invalid_argument("the reference level is the path tracer's");
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

bool calls_for(const Scene& scene, Effect effect) {
    switch (effect) {
        case Effect::sub_samples:
            return true;
        case Effect::shadows:
            return is_lit(scene);
        case Effect::environment:
        case Effect::occlusion:
            return has_environment(scene);
        case Effect::mirrored_environment:
        case Effect::reflected_occlusion:
            return (has_environment(scene) || is_lit(scene)) && any_paint(scene, mirrors);
        case Effect::interreflection:
            return is_lit(scene) || has_environment(scene);
        case Effect::glints:
            return is_lit(scene) && any_paint(scene, has_glints);
        case Effect::film:
            return any_paint(scene, has_film);
        case Effect::relief:
            return !scene.relief.empty();
        case Effect::subsurface:
            return (is_lit(scene) || has_environment(scene)) && spreading_part(scene).has_value();
    }
    throw std::invalid_argument(fmt::format("effect {}", static_cast<int>(effect)));
}

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
