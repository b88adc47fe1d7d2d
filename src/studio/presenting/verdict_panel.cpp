// What a locked round says, and the duel of those that lead it.
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "core/error.h"
#include "evaluation/duel.h"
#include "evaluation/statistics/vote_counts.h"
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
        if (!studio.background || !studio.ballots) return;
        try {
            if (const auto duel = duel_of(*studio.ballots, round.id)) {
                state.verdict = duel->words;
                return draw_verdict(studio, round);
            }
            const auto ballots = std::make_shared<std::vector<RankedBallot>>();
            bool least = round.designs.size() > 2 && round.asks_least;
            for (const CastBallot& cast : studio.ballots->ballots(round.id)) {
                ballots->push_back(
                    {cast.choices.best, cast.choices.second, cast.choices.least.value_or(-1)});
                least = least && cast.choices.least.has_value();
            }
            studio.background->run(
                [&studio, ballots, least, round](const Progress&) -> Background::Then {
                    const VoteCounts counts = counts_of(*ballots,
                                                        static_cast<int>(round.designs.size()),
                                                        least && !ballots->empty());
                    const auto words = vote_statistics(counts,
                                                       round.designs,
                                                       static_cast<std::uint64_t>(round.seed),
                                                       ballots.get())
                                           .words;
                    return [&studio, words, id = round.id] {
                        if (presenting(studio).verdict_round == id)
                            presenting(studio).verdict = words;
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
    if (!round.voting) return told;
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
