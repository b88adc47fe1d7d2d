#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/hash.h"
#include "core/json.h"
#include "core/paths.h"
#include "ledger/accuracy/chain.h"

namespace livery {

std::string hash_of(const ChainPart& part) {
    Hasher hasher;
    const auto add = [&](const std::string& text) {
        hasher.add(text);
        hasher.add(std::string_view("\0", 1));
    };
    for (const ChainRow& row : part.rows) {
        add(row.what);
        add(row.level);
        add(row.against);
    }
    add(part.inputs());
    add(program_hash());
    return hasher.hex();
}

std::optional<std::vector<ChainRow>> read_chain_rows(const std::filesystem::path& folder,
                                                     const std::string& hash) {
    const std::filesystem::path file = folder / (hash + ".json");
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    const Json json = read_json_file(file);
    const JsonReader root(file, json);
    root.require_format_version(1);
    const JsonReader entries = root["rows"];
    std::vector<ChainRow> rows;
    for (std::size_t k = 0; k < entries.size(); ++k) {
        const JsonReader read = entries.at(k);
        const auto number = [&](const char* name) { return read[name].number_between(0.0, 1e12); };
        ChainRow& row = rows.emplace_back();
        row.what = read["what"].text();
        row.level = read["level"].text();
        row.against = read["against"].text();
        if (read.has("ms")) row.ms = number("ms");
        row.compared = static_cast<std::size_t>(number("compared"));
        row.median = number("median");
        row.p95 = number("p95");
        row.p99 = number("p99");
        row.missing = read["missing"].text();
    }
    return rows;
}

void write_chain_rows(const std::filesystem::path& folder,
                      const std::string& hash,
                      const std::vector<ChainRow>& rows) {
    const bool finite = std::all_of(rows.begin(), rows.end(), [](const ChainRow& row) {
        return std::isfinite(row.median) && std::isfinite(row.p95) && std::isfinite(row.p99);
    });
    if (!finite) return;
    Json entries = Json::array();
    for (const ChainRow& row : rows) {
        Json& entry = entries.emplace_back();
        entry = {{"what", row.what},
                 {"level", row.level},
                 {"against", row.against},
                 {"compared", row.compared},
                 {"median", row.median},
                 {"p95", row.p95},
                 {"p99", row.p99},
                 {"missing", row.missing}};
        if (row.ms) entry["ms"] = *row.ms;
    }
    make_output_folder(folder);
    write_json_file(folder / (hash + ".json"), {{"format_version", 1}, {"rows", entries}});
}

}  // namespace livery
