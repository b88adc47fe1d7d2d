#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "ledger/accuracy/accuracy.h"
#include "ledger/accuracy/chain.h"

namespace livery {

namespace {

std::string heading(const AccuracyLedger& ledger) {
    std::string text = fmt::format(
        "OpenGL: {}, {} threads, 640x400. Truth: the path tracer with bounces, two independent "
        "pictures of {} samples a pixel.",
        ledger.renderer,
        ledger.threads,
        ledger.samples_per_pixel);
    if (ledger.missing > 0) {
        text += fmt::format(" {} rows of other shards are not there yet.", ledger.missing);
    }
    return text + "\n";
}

std::string error_of(const AccuracyLevel& level) {
    return fmt::format("{:.2f}{}", level.median, level.resolved ? "" : " (not resolved)");
}

std::string table_of(const std::vector<AccuracyLevel>& levels, bool qualities) {
    std::string text = fmt::format(
        "| {} | level | scenes | {} | new light, ms | swap, ms | CIEDE2000 median | worst 95% | "
        "worst 99% |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        qualities ? "" : "effect",
        qualities ? "" : "its passes, ms");
    for (const AccuracyLevel& level : levels) {
        if ((level.effect == kQualityRows) != qualities) continue;
        text += fmt::format("| {} | {} | {} | {} | {:.0f} | {:.1f} | {} | {:.2f} | {:.2f} |\n",
                            level.index == 0 || qualities ? level.effect : "",
                            level.level,
                            level.scenes,
                            qualities ? "" : fmt::format("{:.0f}", level.own_ms),
                            level.solve_ms,
                            level.swap_ms,
                            error_of(level),
                            level.p95,
                            level.p99);
    }
    return text;
}

/// What the truth itself may err by, a scene a line.
std::string floors_of(const AccuracyLedger& ledger) {
    std::map<std::string, const AccuracyRow*> scenes;
    for (const AccuracyRow& row : ledger.rows) {
        if (row.called_for) scenes.emplace(row.scene, &row);
    }
    std::string text = "| scene | pixels | floor median | floor 95% |\n| --- | --- | --- | --- |\n";
    for (const auto& [name, row] : scenes) {
        text += fmt::format("| {} | {} | {:.2f} | {:.2f} |\n",
                            name,
                            row->error.pixels,
                            row->floor_median,
                            row->floor_p95);
    }
    return text;
}

}  // namespace

std::vector<LedgerEffect> effects_of(const AccuracyLedger& ledger) {
    std::vector<LedgerEffect> effects;
    for (const AccuracyLevel& level : levels_of(ledger)) {
        if (effects.empty() || effects.back().name != level.effect) {
            effects.push_back({level.effect, {}});
        }
        LedgerLevel& row = effects.back().levels.emplace_back();
        row.name = level.level;
        row.ms = row.fastest_ms = level.effect == kQualityRows ? level.solve_ms : level.own_ms;
        row.repeats = level.scenes;
        row.error = level.median;
        row.error_p95 = level.p95;
        row.error_p99 = level.p99;
        row.swap_ms = level.swap_ms;
        row.unit = "CIEDE2000";
    }
    return effects;
}

std::string markdown_of(const AccuracyLedger& ledger) {
    const auto levels = levels_of(ledger);
    return heading(ledger) + "\n" + table_of(levels, true) + "\n" + table_of(levels, false) + "\n" +
           floors_of(ledger);
}

std::string csv_of(const AccuracyLedger& ledger) {
    std::string text =
        "scene,effect,level,called_for,own_ms,solve_ms,swap_ms,pixels,median,p95,p99,worst,"
        "floor_median,floor_p95,floor_p99\n";
    for (const AccuracyRow& row : ledger.rows) {
        text += fmt::format("\"{}\",{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                            row.scene,
                            row.effect,
                            row.level,
                            row.called_for ? 1 : 0,
                            row.own_ms,
                            row.solve_ms,
                            row.swap_ms,
                            row.error.pixels,
                            row.error.median,
                            row.error.p95,
                            row.p99,
                            row.error.worst,
                            row.floor_median,
                            row.floor_p95,
                            row.floor_p99);
    }
    return text;
}

namespace {

std::string ms_text(const ChainRow& row) { return row.ms ? fmt::format("{:.1f}", *row.ms) : ""; }

}  // namespace

std::vector<LedgerEffect> effects_of(const ChainLedger& ledger) {
    std::vector<LedgerEffect> effects;
    for (const ChainRow& row : ledger.rows) {
        if (effects.empty() || effects.back().name != row.what) {
            effects.push_back({row.what, {}});
        }
        LedgerLevel& level = effects.back().levels.emplace_back();
        level.name = row.level;
        level.against = row.against;
        level.missing = row.missing;
        if (row.ms) {
            level.ms = level.fastest_ms = *row.ms;
            level.repeats = 1;
        }
        if (!row.missing.empty()) continue;
        level.work_items = static_cast<double>(row.compared);
        level.error = row.median;
        level.error_p95 = row.p95;
        level.error_p99 = row.p99;
        level.unit = "CIEDE2000";
    }
    return effects;
}

std::string markdown_of(const ChainLedger& ledger) {
    std::string text =
        "\n| the rest of the way | level | ms | CIEDE2000 median | 95% | 99% | compared | against "
        "|\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    const ChainRow* before = nullptr;
    for (const ChainRow& row : ledger.rows) {
        const bool other = !before || before->what != row.what;
        text += fmt::format("| {} | {} | {} | ", other ? row.what : "", row.level, ms_text(row));
        if (row.missing.empty()) {
            text += fmt::format(
                "{:.3f} | {:.3f} | {:.3f} | {} | ", row.median, row.p95, row.p99, row.compared);
        } else {
            text += row.missing + " | | | | ";
        }
        text += fmt::format("{} |\n", other || before->against != row.against ? row.against : "");
        before = &row;
    }
    return text;
}

std::string csv_of(const ChainLedger& ledger) {
    std::string text = "what,level,against,ms,compared,median,p95,p99,missing\n";
    for (const ChainRow& row : ledger.rows) {
        text += fmt::format("\"{}\",\"{}\",\"{}\",{},",
                            row.what,
                            row.level,
                            row.against,
                            row.ms ? fmt::format("{}", *row.ms) : "");
        text += row.missing.empty()
                    ? fmt::format("{},{},{},{},\n", row.compared, row.median, row.p95, row.p99)
                    : fmt::format(",,,,\"{}\"\n", row.missing);
    }
    return text;
}

}  // namespace livery
