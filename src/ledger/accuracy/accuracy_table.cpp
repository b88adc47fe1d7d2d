#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "ledger/accuracy/accuracy.h"

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

std::string text_of(const AccuracyLedger& ledger) {
    std::string text = heading(ledger);
    for (const AccuracyLevel& level : levels_of(ledger)) {
        text += fmt::format(
            "{:<22} {:<14} {:8.0f} ms of its own, {:8.0f} ms new light, {:6.1f} ms swap; CIEDE2000 "
            "{}, worst 95% {:.2f}, 99% {:.2f}\n",
            level.effect,
            level.level,
            level.own_ms,
            level.solve_ms,
            level.swap_ms,
            error_of(level),
            level.p95,
            level.p99);
    }
    return text;
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

}  // namespace livery
