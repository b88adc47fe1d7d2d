#include <algorithm>

#include "appearance/model_table.h"
#include "core/error.h"
#include "core/json.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "ledger/pass_costs.h"

namespace livery {

namespace {

constexpr int kVersion = 3;  ///< 1 timed qualities, 2 counted levels

/// As cost_key() has it; none: this version has no such pass.
std::optional<PassId> pass_of(const std::string& words) {
    std::vector<PassId> known;
    for (int kind = 0; kind <= static_cast<int>(PassKind::prepare); ++kind) {
        known.emplace_back(static_cast<PassKind>(kind));
    }
    const auto add = [&](ReflectanceModel model) {
        for (const bool glints : {false, true}) {
            known.emplace_back(PassKind::shade, "", model, glints);
        }
    };
    for (const ModelInfo& model : formula_models()) add(model.model);
    add(ReflectanceModel::measured);
    const auto found = std::find_if(
        known.begin(), known.end(), [&](const PassId& pass) { return to_string(pass) == words; });
    return found == known.end() ? std::nullopt : std::optional(*found);
}

/// Empty where the pass is of no effect.
std::string level_name(const PassCost& cost) {
    const auto effect = effect_of(cost.pass);
    return effect ? effect_info(*effect).levels.at(static_cast<std::size_t>(cost.level)).name : "";
}

/// None: this version has no such level.
std::optional<int> numbered_level_of(const PassId& pass, const std::string& name) {
    const auto effect = effect_of(pass);
    if (!effect) return name.empty() ? std::optional(0) : std::nullopt;
    const std::vector<EffectLevel>& levels = effect_info(*effect).levels;
    const auto found = std::find_if(
        levels.begin(), levels.end(), [&](const EffectLevel& level) { return name == level.name; });
    if (found == levels.end()) return std::nullopt;
    return static_cast<int>(found - levels.begin());
}

}  // namespace

PassId cost_key(const PassId& pass) {
    // A translucent part is shaded by the same lines.
    const bool translucent = pass.model == ReflectanceModel::translucent;
    return {pass.kind,
            "",
            translucent ? std::optional(ReflectanceModel::ggx) : pass.model,
            pass.glints};
}

int cost_level(const PassId& pass, const EffectLevels& levels) {
    const auto effect = effect_of(pass);
    // Where lamps alone are mirrored a black environment is filtered, which takes as long
    const int at_least = pass == PassKind::environment_filter ? 1 : 0;
    return effect ? std::max(levels[*effect], at_least) : 0;
}

const PassCost* find_cost(const std::vector<PassCost>& costs,
                          const PassId& pass,
                          const EffectLevels& levels) {
    const PassId key = cost_key(pass);
    const int level = cost_level(pass, levels);
    const auto found = std::find_if(costs.begin(), costs.end(), [&](const PassCost& cost) {
        return cost.pass == key && cost.level == level;
    });
    return found == costs.end() ? nullptr : &*found;
}

double predicted_ms(const PassCost& cost, double work_items) {
    if (!(cost.work_items > 0.0)) return cost.ms;
    return cost.fixed_ms + (cost.ms - cost.fixed_ms) * work_items / cost.work_items;
}

const char* to_string(CostOrigin origin) {
    switch (origin) {
        case CostOrigin::shipped:
            return "shipped";
        case CostOrigin::scaled:
            return "scaled";
        case CostOrigin::measured:
            return "measured";
    }
    throw std::invalid_argument("unknown origin of costs");
}

std::filesystem::path pass_costs_file() { return user_folder() / "bench.json"; }

void write_pass_costs(const std::filesystem::path& file, const PassCosts& costs) {
    make_output_folder(file.parent_path());
    Json list = Json::array();
    for (const PassCost& cost : costs.passes) {
        list.push_back({{"pass", to_string(cost.pass)},
                        {"level", level_name(cost)},
                        {"ms", cost.ms},
                        {"fixed_ms", cost.fixed_ms},
                        {"work_items", cost.work_items}});
        if (cost.fragments_per_pixel) {
            list.back()["fragments_per_pixel"] = *cost.fragments_per_pixel;
        }
    }
    write_json_file(file,
                    {{"format_version", kVersion},
                     {"renderer", costs.renderer},
                     {"threads", costs.threads},
                     {"origin", to_string(costs.origin)},
                     {"passes", list}});
}

std::optional<PassCosts> read_pass_costs(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    return parse_pass_costs(read_text_file(file), file);
}

std::optional<PassCosts> parse_pass_costs(const std::string& text,
                                          const std::filesystem::path& file) {
    constexpr double kLongest_ms = 1e9, kMostItems = 1e15;
    constexpr int kMostThreads = 100'000;
    const Json json = parse_json(text, file);
    const JsonReader reader(file, json);
    reader.require_format_version(kVersion);
    if (reader["format_version"].number() < kVersion) return std::nullopt;
    PassCosts costs;
    if (reader.has("renderer")) costs.renderer = reader["renderer"].text();
    if (reader.has("threads")) costs.threads = reader["threads"].integer(1, kMostThreads);
    if (reader.has("origin") && reader["origin"].text() == to_string(CostOrigin::scaled)) {
        costs.origin = CostOrigin::scaled;
    }
    const JsonReader passes = reader["passes"];
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const JsonReader entry = passes.at(i);
        PassCost cost;
        const auto pass = pass_of(entry["pass"].text());
        const std::string level = entry["level"].text();
        cost.ms = entry["ms"].number_between(0.0, kLongest_ms);
        cost.fixed_ms = entry["fixed_ms"].number_between(0.0, cost.ms);
        cost.work_items = entry["work_items"].number_between(0.0, kMostItems);
        if (entry.has("fragments_per_pixel")) {
            cost.fragments_per_pixel = entry["fragments_per_pixel"].number_between(0.01, 1e3);
        }
        if (!pass) continue;  // another version's: no plan of this one lists it
        const auto its_level = numbered_level_of(*pass, level);
        if (!its_level) continue;
        cost.pass = *pass;
        cost.level = *its_level;
        costs.passes.push_back(cost);
    }
    return costs;
}

PassCosts shipped_pass_costs() {
    const std::filesystem::path file = shipped_path("assets/ledger/pass-costs.json");
    auto costs = parse_pass_costs(read_text_file(file), file);
    if (!costs || costs->threads == 0) {
        throw FileError(file, "", "costs of another version", "those of this one, with threads");
    }
    const int threads = thread_count();
    const double factor = static_cast<double>(costs->threads) / threads;
    for (PassCost& cost : costs->passes) {
        cost.ms *= factor;
        cost.fixed_ms *= factor;
    }
    costs->origin = CostOrigin::shipped;
    costs->threads = threads;
    return *costs;
}

PassCosts known_pass_costs() {
    std::filesystem::path file;
    try {
        file = pass_costs_file();
    } catch (const FileError&) {
        return shipped_pass_costs();  // no home folder to keep any in
    }
    if (auto costs = read_pass_costs(file)) return *costs;
    return shipped_pass_costs();
}

}  // namespace livery
