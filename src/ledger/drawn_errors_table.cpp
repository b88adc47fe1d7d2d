// The ledger's rows and tables of what rounding makes of what is drawn.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/worst_error.h"
#include "ledger/drawn_errors.h"

namespace livery {

namespace {

/// The worst of the rows that are `wanted`: "lanes OpenGL"; empty for none.
template <typename Wanted>
std::string worst_cell(const std::vector<DrawnError>& rows, const Wanted& wanted) {
    double lanes = -1.0, gl = -1.0;
    for (const DrawnError& row : rows) {
        if (!wanted(row)) continue;
        lanes = worse_of(lanes, row.in_lanes);
        gl = worse_of(gl, row.in_gl);
    }
    return lanes < 0.0 ? " |" : fmt::format(" {:.1e} {:.1e} |", lanes, gl);
}

std::string rule_of(std::size_t columns) {
    std::string rule = "|";
    for (std::size_t k = 0; k < columns; ++k) rule += " --- |";
    return rule + "\n";
}

/// In the order of their rows.
std::vector<std::string> paints_of(const std::vector<DrawnError>& rows) {
    std::vector<std::string> paints;
    for (const DrawnError& row : rows) {
        if (std::find(paints.begin(), paints.end(), row.paint) == paints.end()) {
            paints.push_back(row.paint);
        }
    }
    return paints;
}

}  // namespace

std::vector<LedgerEffect> effects_of(const std::vector<DrawnError>& rows) {
    std::vector<LedgerEffect> effects;
    for (const DrawnError& row : rows) {
        const std::string name = fmt::format("drawn: {}, {}", row.paint, to_string(row.light));
        auto effect = std::find_if(effects.begin(), effects.end(), [&](const LedgerEffect& known) {
            return known.name == name;
        });
        if (effect == effects.end()) effect = effects.insert(effects.end(), {name, {}});
        for (const bool in_gl : {false, true}) {
            LedgerLevel& level = effect->levels.emplace_back();
            level.name = fmt::format("{}, alpha {:.4g}", in_gl ? "OpenGL" : "lanes", row.alpha);
            level.ms = level.fastest_ms = row.ms;
            level.repeats = 1;
            level.work_items = static_cast<double>(row.values);
            level.error = in_gl ? row.in_gl : row.in_lanes;
            level.unit = "relative";
        }
    }
    return effects;
}

std::string markdown_of(const std::vector<DrawnError>& rows) {
    std::size_t values = 0, invalid = 0, beyond = 0;
    std::set<double> alphas;
    for (const DrawnError& row : rows) {
        values += row.values;
        invalid += row.invalid;
        beyond += row.in_lanes <= row.allowed && row.in_gl <= row.allowed ? 0u : 1u;
        alphas.insert(row.alpha);
    }
    std::string text = fmt::format(
        "{} values drawn: {} no number, infinite or negative; {} of {} rows beyond what is "
        "allowed.\n\n"
        "Worst of all slope parameters, in the lanes of the processor and in OpenGL:\n\n| paint |",
        values,
        invalid,
        beyond,
        rows.size());
    for (const DrawnLight light : kDrawnLights) text += fmt::format(" {} |", to_string(light));
    text += "\n" + rule_of(1 + std::size(kDrawnLights));
    for (const std::string& paint : paints_of(rows)) {
        text += fmt::format("| `{}` |", paint);
        for (const DrawnLight light : kDrawnLights) {
            text += worst_cell(rows, [&](const DrawnError& row) {
                return row.paint == paint && row.light == light;
            });
        }
        text += "\n";
    }
    text += "\nWorst of all paints at each slope parameter, and what is allowed:\n\n| light |";
    for (const double alpha : alphas) text += fmt::format(" {:.3g} |", alpha);
    text += "\n" + rule_of(1 + alphas.size());
    for (const DrawnLight light : kDrawnLights) {
        text += fmt::format("| {} |", to_string(light));
        for (const double alpha : alphas) {
            text += worst_cell(rows, [&](const DrawnError& row) {
                return row.alpha == alpha && row.light == light;
            });
        }
        text += "\n";
    }
    text += "| allowed |";
    for (const double alpha : alphas)
        text += fmt::format(" {:.1e} |", std::max(1e-4, 4e-7 / alpha));
    return text + "\n";
}

}  // namespace livery
