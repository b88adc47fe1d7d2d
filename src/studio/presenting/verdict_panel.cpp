// What a locked round says, and the duel of those that lead it.
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "evaluation/closed_round.h"
#include "evaluation/duel.h"
#include "evaluation/report/round_report.h"
#include "evaluation/statistics/scale_statistics.h"
#include "evaluation/statistics/vote_statistics.h"
#include "studio/kit/theme.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/kit/words.h"
#include "studio/presenting/presenting.h"

namespace livery {

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
            studio.background->run(
                [&studio, round, file = studio.ballots->file()](
                    const Progress&) -> Background::Then {
                    const auto seed = static_cast<std::uint64_t>(round.seed);
                    const ClosedRound closed = read_closed_round(file, round.id, seed);
                    const auto words = round_statistics(closed, seed).words;
                    std::vector<std::string> of_scales;
                    const auto scales =
                        scale_statistics(closed.answers, round.scales, round.designs, seed);
                    for (const ScaleFigures& figures : scales.scales) {
                        of_scales.push_back(figures.words);
                    }
                    return [&studio, words, of_scales, id = round.id] {
                        PresentingState& shown = presenting(studio);
                        if (shown.verdict_round != id) return;
                        shown.verdict = words;
                        shown.scale_verdicts = of_scales;
                    };
                },
                [&studio](std::exception_ptr why) {
                    notify_failure(studio, "The verdict could not be found.", why);
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
