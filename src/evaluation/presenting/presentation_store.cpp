// What the ballots keep of presentations: in their log, with everything else that happened.
#include <limits>

#include "core/error.h"
#include "core/time.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_rows.h"
#include "evaluation/ballot_tables.h"
#include "evaluation/ballots.h"

namespace livery {

namespace {

using What = LogEntry::What;

std::string text_of_entry(Database& database, const char* what, int round) {
    const auto rows =
        database.run("SELECT text FROM log WHERE what = ?1 AND round = ?2 ORDER BY id DESC LIMIT 1",
                     {std::string(what), std::int64_t{round}});
    return rows.empty() ? std::string() : as_text(database, rows[0][0]);
}

std::string name_of_file(const Database& database) { return database.file().string(); }

bool is_in(const PresentationPlan& plan, const PresentationState& state) {
    return state.sitting < static_cast<int>(plan.sittings.size()) &&
           state.place <
               static_cast<int>(plan.sittings[static_cast<std::size_t>(state.sitting)].size());
}

}  // namespace

void BallotStore::record_step(int id, const PresentationState& state, PresentationEvent event) {
    Transaction transaction(database_);
    const Round round = round_of(database_, id);
    const auto plan = plan_of(id);
    if (!plan) {
        throw Refused("round " + std::to_string(id) + " was opened without a presentation",
                      "lock it, and present its looks anew");
    }
    check_argument(is_in(*plan, state),
                   "record_step: found " + text_of(state, event) +
                       ", expected a sitting and a place of the plan");
    LogEntry entry{.session = round.session, .round = id, .at = utc_now()};
    // Votes count from here on, before anybody is told that they do.
    if (state.phase == PresentationPhase::voting && !round.voting && !round.closed) {
        entry.what = What::voting;
        record(database_, entry);
    }
    const bool ends = state.phase == PresentationPhase::locked || event == PresentationEvent::abort;
    if (ends && !round.closed) {
        entry.what = What::close;
        record(database_, entry);
    }
    entry.what = What::shown;
    entry.at = utc_now_ms();
    entry.text = text_of(state, event);
    entry.best = design_of(*plan, state);
    entry.second = state.place;
    entry.seat = state.sitting;
    // The wave of this sitting votes from here on.
    entry.least = state.phase == PresentationPhase::voting ? 1 : -1;
    record(database_, entry);
    transaction.commit();
}

std::optional<PresentationPlan> BallotStore::plan_of(int round) const {
    const std::string text = text_of_entry(database_, "plan", round);
    if (text.empty()) return std::nullopt;
    return parse_plan(text, name_of_file(database_));
}

Turn BallotStore::turn_of(int round, int seat) const {
    const std::vector<DatabaseValue> at = {std::int64_t{round}, std::int64_t{seat}};
    const auto rows = database_.run(
        "SELECT wave, voting IS NOT NULL, "
        "(SELECT count(*) FROM waves WHERE round = ?1), "
        "(SELECT coalesce(max(seat), 0) FROM log WHERE what = 'shown' AND round = ?1) "
        "FROM sitters JOIN waves USING (round, wave) WHERE round = ?1 AND seat = ?2",
        at);
    if (rows.empty()) return {};
    Turn turn;
    turn.wave = as_int(database_, rows[0][0]);
    turn.votes = as_int(database_, rows[0][1]) != 0;
    turn.waves = as_int(database_, rows[0][2]);
    turn.sits = turn.votes || as_int(database_, rows[0][3]) >= turn.wave;
    return turn;
}

std::vector<PresentationStep> BallotStore::steps_of(int round) const {
    std::vector<PresentationStep> steps;
    for (const auto& row :
         database_.run("SELECT at, text FROM log WHERE what = 'shown' AND round = ?1 ORDER BY id",
                       {std::int64_t{round}})) {
        steps.push_back(parse_step(as_text(database_, row[1]), name_of_file(database_)));
        steps.back().at = as_text(database_, row[0]);
    }
    return steps;
}

std::optional<BallotStore::Presented> BallotStore::presented() const {
    const auto planned =
        database_.run("SELECT round FROM log WHERE what = 'plan' ORDER BY id DESC LIMIT 1");
    if (planned.empty()) return std::nullopt;
    Presented found;
    found.round = round_of(database_, as_int(database_, planned[0][0]));
    found.plan = plan_of(found.round.id).value();
    const std::string text = text_of_entry(database_, "shown", found.round.id);
    if (text.empty()) {
        // Killed between the opening and the first step.
        if (found.round.closed) return std::nullopt;
        found.step.state = after(found.plan, {}, PresentationEvent::present, 0.0);
        return found;
    }
    found.step = parse_step(text, name_of_file(database_));
    PresentationState& state = found.step.state;
    if (state.phase == PresentationPhase::edit) return std::nullopt;
    // Another program may have locked it, or let people vote.
    if (found.round.closed) state.phase = PresentationPhase::locked;
    if (!is_in(found.plan, state)) {
        fail_ballots(database_,
                     "round " + std::to_string(found.round.id),
                     "a step of its presentation that its plan does not have");
    }
    return found;
}

}  // namespace livery
