#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/hash.h"
#include "core/paths.h"
#include "ledger/accuracy/rows_json.h"

namespace livery {

const std::string& program_hash() {
    static const std::string hash = [] {
        constexpr std::size_t kLargest = std::size_t{4} << 30u;
        Hasher hasher;
        hasher.add(read_text_file("/proc/self/exe", kLargest));
        return hasher.hex();
    }();
    return hash;
}

namespace {

/// JSON knows no infinity.
constexpr double kMost = 1e12;

/// -1: not of this version.
int index_of(const AccuracyRow& row) {
    const auto place_in = [&](const auto& names, const auto& name_of) {
        const auto found = std::find_if(
            names.begin(), names.end(), [&](const auto& one) { return name_of(one) == row.level; });
        return found == names.end() ? -1 : static_cast<int>(found - names.begin());
    };
    if (row.effect == kQualityRows) {
        constexpr std::array kDrawn{Quality::draft, Quality::normal, Quality::high};
        return place_in(kDrawn, [](Quality one) { return to_string(one); });
    }
    for (const EffectInfo& info : effect_table()) {
        if (info.name != row.effect) continue;
        return place_in(info.levels, [](const EffectLevel& one) { return std::string(one.name); });
    }
    return -1;
}

}  // namespace

Json json_of(const AccuracyRow& row) {
    const auto finite = [](double error) { return std::min(error, kMost); };
    return {{"format_version", 1},
            {"scene", row.scene},
            {"effect", row.effect},
            {"level", row.level},
            {"own_ms", row.own_ms},
            {"solve_ms", row.solve_ms},
            {"swap_ms", row.swap_ms},
            {"fragments", row.fragments},
            {"pixels", row.error.pixels},
            {"median", finite(row.error.median)},
            {"p95", finite(row.error.p95)},
            {"p99", finite(row.p99)},
            {"mean", finite(row.error.mean)},
            {"worst", finite(row.error.worst)},
            {"floor_median", finite(row.floor_median)},
            {"floor_p95", finite(row.floor_p95)},
            {"floor_p99", finite(row.floor_p99)}};
}

AccuracyRow read_row(const JsonReader& read) {
    const auto number = [&](const char* name) { return read[name].number_between(0.0, kMost); };
    AccuracyRow row;
    row.scene = read["scene"].text();
    row.effect = read["effect"].text();
    row.level = read["level"].text();
    row.index = index_of(row);
    row.own_ms = number("own_ms");
    row.solve_ms = number("solve_ms");
    row.swap_ms = number("swap_ms");
    row.fragments = number("fragments");
    row.error.pixels = static_cast<std::size_t>(number("pixels"));
    row.error.median = number("median");
    row.error.p95 = number("p95");
    row.p99 = number("p99");
    row.error.mean = number("mean");
    row.error.worst = number("worst");
    row.floor_median = number("floor_median");
    row.floor_p95 = number("floor_p95");
    row.floor_p99 = number("floor_p99");
    return row;
}

std::string hash_of(const AccuracyRow& row, const std::string& truth_hash) {
    Hasher hasher;
    hasher.add(truth_hash);
    hasher.add(row.effect);
    hasher.add(row.level);
    hasher.add(std::span<const int>(row.levels.of));
    hasher.add(program_hash());
    return hasher.hex();
}

std::optional<AccuracyRow> read_row(const std::filesystem::path& folder, const std::string& hash) {
    const std::filesystem::path file = folder / (hash + ".json");
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return std::nullopt;
    const Json json = read_json_file(file);
    const JsonReader read(file, json);
    read.require_format_version(1);
    return read_row(read);
}

void write_row(const std::filesystem::path& folder,
               const std::string& hash,
               const AccuracyRow& row) {
    make_output_folder(folder);
    write_json_file(folder / (hash + ".json"), json_of(row));
}

}  // namespace livery
