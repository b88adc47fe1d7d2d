#include <fmt/format.h>

#include "ledger/accuracy/chain.h"

namespace livery {

namespace {

std::string milliseconds_of(const ChainRow& row) {
    return row.ms ? fmt::format("{:.1f}", *row.ms) : "";
}

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

std::string text_of(const ChainLedger& ledger) {
    std::string text = "the rest of the way\n";
    for (const ChainRow& row : ledger.rows) {
        text += fmt::format("{:<44} {:<30} ", row.what, row.level);
        if (!row.missing.empty()) {
            text += row.missing + "\n";
            continue;
        }
        text += fmt::format("{:>10}; CIEDE2000 {:.3f}, 95% {:.3f}, 99% {:.3f} of {}, against {}\n",
                            row.ms ? milliseconds_of(row) + " ms" : "",
                            row.median,
                            row.p95,
                            row.p99,
                            row.compared,
                            row.against);
    }
    return text;
}

std::string markdown_of(const ChainLedger& ledger) {
    std::string text =
        "\n| the rest of the way | level | ms | CIEDE2000 median | 95% | 99% | compared | against "
        "|\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
    const ChainRow* before = nullptr;
    for (const ChainRow& row : ledger.rows) {
        const bool other = !before || before->what != row.what;
        text += fmt::format(
            "| {} | {} | {} | ", other ? row.what : "", row.level, milliseconds_of(row));
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
