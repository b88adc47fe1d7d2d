#include "evaluation/report/round_record.h"

#include <algorithm>

#include "evaluation/ballots.h"

namespace livery {

namespace {

std::vector<LookShowing> showings_of(const PresentationPlan& plan,
                                     const std::vector<PresentationStep>& steps,
                                     const std::vector<int>& codes) {
    std::vector<LookShowing> showings;
    int sitting = -1, shown = -1;
    for (const PresentationStep& step : steps) {
        const int design = design_of(plan, step.state);
        if (design < 0) {
            shown = -1;  // grey, white: the next look is shown anew
            continue;
        }
        if (step.state.sitting != sitting) {
            const auto at = static_cast<std::size_t>(step.state.sitting);
            showings.push_back(
                {step.at, at < plan.seats.size() ? plan.seats[at] : std::vector<int>(), {}});
        }
        sitting = step.state.sitting;
        const bool again = step.event == PresentationEvent::repeat;
        const int place = step.state.place;
        if (place != shown || again) {
            showings.back().codes.push_back(codes.at(static_cast<std::size_t>(design)));
        }
        shown = place;
    }
    return showings;
}

}  // namespace

RoundRecord read_round_record(const std::filesystem::path& file,
                              std::optional<int> id,
                              std::uint64_t seed) {
    RoundRecord record;
    record.round = read_closed_round(file, id, seed);
    record.file = file.filename().string();
    const BallotStore store(file);
    for (const Round& round : store.rounds()) {
        if (round.id != record.round.id) continue;
        record.codes = round.codes;
        record.codes_seed = round.seed;
        record.asks_least = round.asks_least;
        record.session = round.session;
    }
    if (const auto plan = store.plan_of(record.round.id)) {
        record.showings = showings_of(*plan, store.steps_of(record.round.id), record.codes);
    }
    record.duel = duel_of(store, record.round.id);
    record.seats = static_cast<int>(store.seats(record.session).size());
    for (const LogEntry& entry : store.log()) {
        if (entry.round != record.round.id) continue;
        if (entry.what == LogEntry::What::voting) record.voting_at = entry.at;
        if (entry.what == LogEntry::What::close) {
            record.locked_at = entry.at;
            record.log_entry = entry.id;
            record.log_hash = entry.hash;
        }
    }
    return record;
}

}  // namespace livery
