#include <algorithm>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "ledger/effect_errors.h"

namespace livery {

namespace {

bool tells_of_every_effect(const EffectErrors& errors) {
    for (std::size_t e = 0; e < kEffects; ++e) {
        const bool told = std::any_of(errors.begin(), errors.end(), [&](const SceneErrors& one) {
            return !one.at_level[e].empty();
        });
        if (!told) return false;
    }
    return true;
}

}  // namespace

std::filesystem::path effect_errors_file() { return user_folder() / "effect-errors.json"; }

void write_effect_errors(const std::filesystem::path& file, const EffectErrors& errors) {
    make_output_folder(file.parent_path());
    Json scenes = Json::array();
    for (const SceneErrors& scene : errors) {
        Json effects = Json::object();
        for (const EffectInfo& info : effect_table()) {
            const auto& levels = scene.at_level[static_cast<std::size_t>(info.effect)];
            if (levels.empty()) continue;
            Json& entry = effects[info.name] = Json::object();
            for (std::size_t k = 0; k < levels.size(); ++k) {
                entry[info.levels[k].name] = levels[k];
            }
        }
        scenes.push_back(
            {{"scene", scene.scene}, {"dearest", scene.dearest}, {"effects", effects}});
    }
    write_json_file(
        file, {{"format_version", 1}, {"unit", "CIEDE2000, 95th percentile"}, {"scenes", scenes}});
}

EffectErrors parse_effect_errors(const std::string& text, const std::filesystem::path& file) {
    constexpr double kLargest = 1e6;
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(1);
    EffectErrors errors;
    const JsonReader scenes = root["scenes"];
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const JsonReader entry = scenes.at(i);
        SceneErrors& scene = errors.emplace_back();
        scene.scene = entry["scene"].text();
        scene.dearest = entry["dearest"].number_between(0.0, kLargest);
        const JsonReader effects = entry["effects"];
        for (const EffectInfo& info : effect_table()) {
            if (!effects.has(info.name)) continue;
            const JsonReader levels = effects[info.name];
            // Another version's levels: what they leave is not known of ours
            const bool ours =
                std::all_of(info.levels.begin(), info.levels.end(), [&](const EffectLevel& level) {
                    return levels.has(level.name);
                });
            if (!ours) continue;
            for (const EffectLevel& level : info.levels) {
                scene.at_level[static_cast<std::size_t>(info.effect)].push_back(
                    levels[level.name].number_between(0.0, kLargest));
            }
        }
    }
    return errors;
}

EffectErrors known_effect_errors() {
    const std::filesystem::path shipped = shipped_path("assets/ledger/effect-errors.json");
    std::error_code error;
    std::filesystem::path file;
    try {
        file = effect_errors_file();
    } catch (const FileError&) {
        // No home folder to keep one in
    }
    if (!file.empty() && std::filesystem::exists(file, error)) {
        EffectErrors measured = parse_effect_errors(read_text_file(file), file);
        // An earlier version's knows less: what it has no error of would cost nothing to leave out
        if (tells_of_every_effect(measured)) return measured;
    }
    return parse_effect_errors(read_text_file(shipped), shipped);
}

}  // namespace livery
