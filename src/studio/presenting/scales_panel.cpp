// Between which words evaluators may place the looks, once they have voted.
// What a locked round says, and the duel of those that lead it.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "core/error.h"
#include "evaluation/closed_round.h"
#include "evaluation/duel.h"
#include "evaluation/report/round_report.h"
#include "evaluation/statistics/scale_statistics.h"
#include "evaluation/statistics/vote_statistics.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/presenting/presenting.h"

namespace livery {

namespace {

void add_scale(Studio& studio, const SemanticScale& scale) {
    PresentingState& state = presenting(studio);
    PresentingSettings& settings = presenting_settings(studio);
    auto scales = settings.scales;
    scales.push_back(scale);
    try {
        check_scales(scales);
        settings.scales = std::move(scales);
        state.scale_low.clear();
        state.scale_high.clear();
        state.scale_problem.clear();
        keep_presenting_settings(studio);
    } catch (const std::invalid_argument& error) {
        state.scale_problem = error.what();
    }
}

void draw_listed(Studio& studio) {
    PresentingSettings& settings = presenting_settings(studio);
    std::optional<std::size_t> removed;
    for (std::size_t k = 0; k < settings.scales.size(); ++k) {
        ImGui::PushID(static_cast<int>(k));
        if (named(ImGui::SmallButton("x"), fmt::format("scales:remove:{}", k), "Not these words."))
            removed = k;
        ImGui::SameLine();
        ImGui::TextUnformatted(in_words(settings.scales[k]).c_str());
        name_last_item(fmt::format("scales:pair:{}", k));
        ImGui::PopID();
    }
    if (!removed) return;
    settings.scales.erase(settings.scales.begin() + static_cast<std::ptrdiff_t>(*removed));
    keep_presenting_settings(studio);
}

void draw_new(Studio& studio) {
    PresentingState& state = presenting(studio);
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x, add = button_width("Add");
    const float width = std::floor(0.5f * (ImGui::GetContentRegionAvail().x - add - 2.0f * gap));
    ImGui::SetNextItemWidth(width);
    named(ImGui::InputTextWithHint("##low", "cheap", &state.scale_low), "scales:low");
    ImGui::SameLine(0.0f, gap);
    ImGui::SetNextItemWidth(width);
    named(ImGui::InputTextWithHint("##high", "precious", &state.scale_high), "scales:high");
    ImGui::SameLine(0.0f, gap);
    if (button("Add", "scales:add", "Two opposite words, of at most 24 characters each."))
        add_scale(studio, {state.scale_low, state.scale_high});
}

void draw_suggestions(Studio& studio) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    const bool open = named(ImGui::BeginCombo("##suggested", "Suggestions"), "scales:suggestions");
    if (!open) return;
    const auto& listed = presenting_settings(studio).scales;
    const auto& suggested = suggested_scales();
    for (std::size_t k = 0; k < suggested.size(); ++k) {
        if (std::find(listed.begin(), listed.end(), suggested[k]) != listed.end()) continue;
        if (ImGui::Selectable(in_words(suggested[k]).c_str())) {
            add_scale(studio, SemanticScale(suggested[k]));
        }
        name_last_item(fmt::format("scales:suggestion:{}", k));
    }
    ImGui::EndCombo();
}

}  // namespace

void draw_scales_setup(Studio& studio) {
    PresentingSettings& settings = presenting_settings(studio);
    // Beside the other tick, where there is room.
    constexpr const char* label = "Ask on scales";
    place_in_row(button_width(label) + ImGui::GetFrameHeight());
    if (ImGui::Checkbox(label, &settings.asks_scales)) {
        keep_presenting_settings(studio);
    }
    name_last_item("present:scales");
    tooltip(
        "After the ballot a phone asks, look by look, where it lies between two opposite words, in "
        "seven steps. Nobody has to answer.");
    if (!settings.asks_scales) return;
    ImGui::Indent();
    draw_listed(studio);
    if (settings.scales.empty()) dim_text("No words yet: nothing is asked.");
    if (settings.scales.size() < kMostScales) {
        draw_new(studio);
        draw_suggestions(studio);
    }
    const std::string& problem = presenting(studio).scale_problem;
    if (!problem.empty()) {
        warning_text(problem);
        name_last_item("scales:problem");
    }
    ImGui::Unindent();
}

void draw_verdict(Studio& studio, const Round& round) {
    PresentingState& state = presenting(studio);
    if (state.verdict_round != round.id) {
        state.verdict_round = round.id;
        state.verdict.clear();
        state.scale_verdicts.clear();
        if (!studio.background || !studio.ballots) return;
        try {
            if (const auto duel = duel_of(*studio.ballots, round.id)) {
                state.verdict = duel->words;
                return draw_verdict(studio, round);
            }
            in_background(studio,
                          "The verdict could not be found.",
                          [&studio, round, file = studio.ballots->file()](
                              const Progress&) -> Background::Then {
                              const auto seed = static_cast<std::uint64_t>(round.seed);
                              const ClosedRound closed = read_closed_round(file, round.id, seed);
                              const auto words = round_statistics(closed, seed).words;
                              std::vector<std::string> of_scales;
                              const auto scales = scale_statistics(
                                  closed.answers, round.scales, round.designs, seed);
                              for (const ScaleFigures& figures : scales.scales) {
                                  of_scales.push_back(figures.words);
                              }
                              return [&studio, words, of_scales, id = round.id] {
                                  PresentingState& shown = presenting(studio);
                                  if (shown.verdict_round != id) return;
                                  shown.verdict = words;
                                  shown.scale_verdicts = of_scales;
                              };
                          });
        } catch (const std::exception& error) {
            state.verdict = error.what();
        }
    }
    if (state.verdict.empty()) return;
    ImGui::PushFont(heading_font());
    ImGui::TextWrapped("%s", sentence(state.verdict).c_str());
    ImGui::PopFont();
    name_last_item("ballot:verdict");
    for (const std::string& words : state.scale_verdicts) ImGui::TextWrapped("%s", words.c_str());
}

bool draw_duel(Studio& studio, const Round& round) {
    if (!studio.ballots) return true;
    const auto series = studio.ballots->series_of(round.id);
    const bool told = !series || series->over;
    if (series && series->over) {
        dim_text(fmt::format("A duel of {} in {} repeats; these are the counts of round {} alone.",
                             listed(series->designs),
                             series->rounds.size(),
                             round.id));
        return told;
    }
    if (series) {
        ImGui::TextWrapped("%s",
                           fmt::format("Repeat {} of {} is locked. Its counts are told with those "
                                       "of the last one, so that nobody is swayed.",
                                       series->rounds.size(),
                                       series->repeats)
                               .c_str());
        name_last_item("duel:words");
    }
    // Nobody leads a round without ballots.
    if (!round.voting() || (!series && round.ballots == 0)) return told;
    if (ImGui::Button(series ? "Next repeat" : "Duel of the first two", {-FLT_MIN, em(2.4f)})) {
        presenting(studio).duel_wanted = round.id;
    }
    name_last_item(series ? "duel:next" : "duel:begin");
    tooltip(series ? "The same two looks, under other codes and in another order."
                   : "The two looks with the largest worths, shown to the same people three times "
                     "blind, each time under other codes. A test by itself: this round's votes "
                     "are not added.");
    return told;
}

}  // namespace livery
