#include <algorithm>

#include "appearance/model_table.h"
#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "ledger/predictions.h"

namespace livery {

namespace {

Quality read_quality(const JsonReader& field) {
    const std::string name = field.text();
    try {
        return parse_quality(name);
    } catch (const std::invalid_argument&) {
        field.fail(field.found(), "draft, normal, high or reference");
    }
}

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
    for (const ModelInfo& model : model_table()) add(model.model);
    add(ReflectanceModel::measured);
    const auto found = std::find_if(
        known.begin(), known.end(), [&](const PassId& pass) { return to_string(pass) == words; });
    return found == known.end() ? std::nullopt : std::optional(*found);
}

}  // namespace

std::filesystem::path ledger_file() { return user_folder() / "bench.json"; }

void write_pass_costs(const std::filesystem::path& file,
                      const std::string& renderer,
                      const std::vector<PassCost>& costs) {
    make_output_folder(file.parent_path());
    Json list = Json::array();
    for (const PassCost& cost : costs) {
        list.push_back({{"pass", to_string(cost.pass)},
                        {"quality", to_string(cost.quality)},
                        {"ms", cost.ms},
                        {"work_items", cost.work_items}});
        if (cost.error) list.back()["error"] = *cost.error;
    }
    write_json_file(file, {{"format_version", 1}, {"renderer", renderer}, {"passes", list}});
}

std::optional<std::vector<PassCost>> read_pass_costs(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    return parse_pass_costs(read_text_file(file), file);
}

std::vector<PassCost> parse_pass_costs(const std::string& text, const std::filesystem::path& file) {
    const Json json = parse_json(text, file);
    const JsonReader reader(file, json);
    reader.require_format_version(1);
    std::vector<PassCost> costs;
    const JsonReader passes = reader["passes"];
    for (std::size_t i = 0; i < passes.size(); ++i) {
        const JsonReader entry = passes.at(i);
        PassCost cost;
        const auto pass = pass_of(entry["pass"].text());
        cost.quality = read_quality(entry["quality"]);
        cost.ms = entry["ms"].number_between(0.0, 1e9);
        cost.work_items = entry["work_items"].number_between(0.0, 1e12);
        if (entry.has("error")) cost.error = entry["error"].number_between(0.0, 1e6);
        if (!pass) continue;  // another version's: no plan of this one lists it
        cost.pass = *pass;
        costs.push_back(cost);
    }
    return costs;
}

}  // namespace livery
