#include "evaluation/ballots.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "core/paths.h"
#include "core/time.h"
#include "evaluation/ballot_log.h"
#include "evaluation/ballot_rows.h"
#include "evaluation/ballot_tables.h"
#include "evaluation/ballots_v1.h"
#include "evaluation/ballots_v3.h"
#include "evaluation/design_codes.h"
#include "evaluation/evaluator_name.h"
#include "evaluation/presenting/sittings.h"

namespace livery {

namespace {

constexpr std::int32_t kApplicationId = 0x4c765642;  // "LvVB"
constexpr int kVersion = 4;
constexpr std::size_t kReceiptDigits = 8;

using What = LogEntry::What;

const char* const kBallotColumns =
    "SELECT ballots.seat, ballots.best, ballots.second, ballots.least, log.hash "
    "FROM ballots JOIN log ON log.id = ballots.entry ";

CastBallot ballot_from(Database& database, const std::vector<DatabaseValue>& row) {
    CastBallot ballot;
    ballot.seat = as_int(database, row[0]);
    ballot.choices.best = as_int(database, row[1]);
    ballot.choices.second = as_int(database, row[2]);
    if (!std::holds_alternative<std::monostate>(row[3])) {
        ballot.choices.least = as_int(database, row[3]);
    }
    ballot.receipt = as_text(database, row[4]).substr(0, kReceiptDigits);
    return ballot;
}

std::optional<CastBallot> ballot_at(Database& database, const Round& round, int seat) {
    const auto rows =
        database.run(std::string(kBallotColumns) +
                         "WHERE ballots.session = ?1 AND ballots.round = ?2 AND ballots.seat = ?3",
                     {std::int64_t{round.session}, std::int64_t{round.id}, std::int64_t{seat}});
    if (rows.empty()) return std::nullopt;
    return ballot_from(database, rows[0]);
}

void check_choices(const Choices& choices, const Round& round, const std::string& who) {
    const std::string ballot = "ballot of " + who + ": ";
    check_argument(choices.best != choices.second,
                   ballot + "found design " + std::to_string(choices.best) +
                       " as best and as second best, expected two designs");
    check_argument(!choices.least || round.asks_least,
                   ballot + "found a least one, expected none: " + round_name(round.id) +
                       " does not ask for it");
    check_argument(choices.least != choices.best && choices.least != choices.second,
                   ballot + "found design " + std::to_string(choices.least.value_or(-1)) +
                       " as least and as one of the best, expected another");
    const int designs = static_cast<int>(round.designs.size());
    for (const int design : {choices.best, choices.second, choices.least.value_or(choices.best)}) {
        check_argument(design >= 0 && design < designs,
                       ballot + "found design " + std::to_string(design) + ", expected 0 to " +
                           std::to_string(designs - 1));
    }
}

void check_setup(const RoundSetup& setup) {
    check_argument(setup.designs.size() >= 2,
                   "open_round: found " + std::to_string(setup.designs.size()) +
                       " designs, expected at least 2 to choose between");
    std::set<std::string> names;
    for (const auto& name : setup.designs) {
        check_argument(!name.empty(), "open_round: found a design without a name");
        check_argument(names.insert(name).second,
                       "open_round: found \"" + name + "\" twice, expected different names");
    }
    if (setup.plan) {
        check_plan(*setup.plan, static_cast<int>(setup.designs.size()));
        check_argument(setup.presenting, "open_round: found a plan for a round that votes at once");
    }
    check_scales(setup.scales);
    check_argument(!setup.series || setup.designs.size() == 2,
                   "open_round: found " + std::to_string(setup.designs.size()) +
                       " designs in a series of repeats, expected 2");
    if (setup.codes.empty()) return;
    check_argument(setup.codes.size() == setup.designs.size(),
                   "open_round: found " + std::to_string(setup.codes.size()) + " codes for " +
                       std::to_string(setup.designs.size()) + " designs, expected one each");
    std::set<int> codes;
    for (const int code : setup.codes) {
        check_argument(code >= 100 && code <= 999 && codes.insert(code).second,
                       "open_round: found code " + std::to_string(code) +
                           ", expected different numbers from 100 to 999");
    }
}

/// Who voted what is nobody else's to read. SQLite gives its logs the rights of the file.
const std::filesystem::path& kept_private(const std::filesystem::path& file) {
    make_private_file(file);
    for (const char* suffix : {"-wal", "-shm"}) {
        auto log = file;
        log += suffix;
        if (std::filesystem::exists(log)) make_private_file(log);
    }
    return file;
}

}  // namespace

const std::vector<std::string>& ballots_schema() {
    static const std::vector<std::string> statements = [] {
        std::vector<std::string> all = ballot_tables_schema();
        for (std::string& statement : ballots_v1_schema()) all.push_back(std::move(statement));
        for (const int format : {2, 3}) {
            for (std::string& statement : log_schema(format)) all.push_back(std::move(statement));
        }
        return all;
    }();
    return statements;
}

BallotStore::BallotStore(const std::filesystem::path& file)
    : database_(
          kept_private(file), Database::Mode::create, kApplicationId, kVersion, ballots_schema()) {
    database_.run("PRAGMA foreign_keys = ON");
    Transaction transaction(database_);
    if (database_.version() != kVersion) {
        if (database_.version() == 1) {
            migrate_ballots_v1(database_);
        } else if (database_.version() == 2 || database_.version() == 3) {
            migrate_ballots_v3(database_, database_.version());
        } else {
            for (const std::string& statement : ballot_tables_schema()) database_.run(statement);
        }
        database_.set_version(kVersion);
    }
    // A damaged index would hide ballots that the log's check finds in the tables.
    const auto sound = database_.run("PRAGMA integrity_check(1)");
    if (const std::string found = as_text(database_, sound.at(0).at(0)); found != "ok") {
        fail_ballots(database_, "", "a damaged database (" + found + ")");
    }
    check_against_log(database_);
    transaction.commit();
}

// --- rounds ---

int BallotStore::open_round(const RoundSetup& setup) {
    check_setup(setup);
    Transaction transaction(database_);
    if (const auto other = open_round()) {
        throw Refused(round_name(other->id) + " is still open", "close it before opening the next");
    }
    auto session = newest_session(database_);
    if (!session) session = make_session(database_);
    if (setup.series) check_series(setup, *session);
    const int round =
        as_int(database_, database_.run("SELECT coalesce(max(id), 0) FROM rounds")[0][0]) + 1;
    const auto codes = setup.codes.empty() ? draw_codes(static_cast<int>(setup.designs.size()),
                                                        static_cast<std::uint64_t>(setup.seed),
                                                        round)
                                           : setup.codes;
    const LogEntry base{.session = *session, .round = round, .at = utc_now()};
    LogEntry opening = base;
    opening.what = What::open;
    opening.text = setup.calibration_id;
    opening.best = setup.asks_least ? 1 : 0;
    opening.second = setup.seed;
    record(database_, opening);
    for (std::size_t k = 0; k < setup.designs.size(); ++k) {
        LogEntry design = base;
        design.what = What::design;
        design.text = setup.designs[k];
        design.best = static_cast<int>(k);
        design.second = codes[k];
        record(database_, design);
    }
    for (std::size_t k = 0; k < setup.scales.size(); ++k) {
        LogEntry scale = base;
        scale.what = What::scale;
        scale.text = setup.scales[k].low + '\t' + setup.scales[k].high;
        scale.best = static_cast<int>(k);
        record(database_, scale);
    }
    if (setup.series) {
        LogEntry series = base;
        series.what = What::series;
        series.seat = setup.series->series == 0 ? round : setup.series->series;
        series.best = setup.series->repeats;
        series.second = setup.series->follows;
        record(database_, series);
    }
    if (!setup.presenting) {
        LogEntry voting = base;
        voting.what = What::voting;
        record(database_, voting);
    }
    if (setup.plan) {
        LogEntry plan = base;
        plan.what = What::plan;
        PresentationPlan dealt = *setup.plan;
        const auto phones = phone_seats(database_, *session);
        if (dealt.sittings.size() > 1 && dealt.seats.empty() && !phones.empty()) {
            dealt.seats = deal_seats(phones, static_cast<int>(dealt.sittings.size()));
        }
        plan.text = text_of(dealt);
        record(database_, plan);
    }
    transaction.commit();
    return round;
}

void BallotStore::start_voting(int id) {
    Transaction transaction(database_);
    const Round round = round_of(database_, id);
    if (round.closed) {
        throw Refused(round_name(id) + " is closed already", "open a new round to vote again");
    }
    if (round.voting) throw Refused(round_name(id) + " takes votes already", "vote");
    record(database_,
           {.what = What::voting, .session = round.session, .round = id, .at = utc_now()});
    transaction.commit();
}

void BallotStore::close_round(int id) {
    Transaction transaction(database_);
    const Round round = round_of(database_, id);
    if (round.closed) {
        throw Refused(round_name(id) + " is closed already", "open a new round to vote again");
    }
    record(database_,
           {.what = What::close, .session = round.session, .round = id, .at = utc_now()});
    transaction.commit();
}

std::vector<Round> BallotStore::rounds() const {
    return rounds_where(database_, "ORDER BY id", {});
}

std::optional<Round> BallotStore::open_round() const {
    auto found = rounds_where(database_, "WHERE closed IS NULL", {});
    if (found.empty()) return std::nullopt;
    return std::move(found.front());
}

std::optional<Round> BallotStore::last_round(int session) const {
    auto found = rounds_where(
        database_, "WHERE session = ?1 ORDER BY id DESC LIMIT 1", {std::int64_t{session}});
    if (found.empty()) return std::nullopt;
    return std::move(found.front());
}

// --- ballots ---

CastBallot BallotStore::vote(int round, const Ballot& ballot) {
    Transaction transaction(database_);
    const CastBallot cast = vote_by_name(round, ballot);
    transaction.commit();
    return cast;
}

std::vector<CastBallot> BallotStore::vote(int round, const std::vector<Ballot>& ballots) {
    Transaction transaction(database_);
    std::vector<CastBallot> cast;
    for (const Ballot& ballot : ballots) cast.push_back(vote_by_name(round, ballot));
    transaction.commit();
    return cast;
}

/// Within the caller's transaction.
CastBallot BallotStore::vote_by_name(int round, const Ballot& ballot) {
    const std::string name = tidy_name(ballot.evaluator);
    const Choices choices{ballot.best, ballot.second, ballot.least};
    const int session = round_of(database_, round).session;
    auto seat = seat_with_key(database_, session, named_seat_key(name));
    if (!seat) seat = make_seat(database_, session, name, false);
    return vote_within(round, *seat, choices, name);
}

CastBallot BallotStore::vote(int round, int seat, const Choices& choices) {
    Transaction transaction(database_);
    const CastBallot cast = vote_within(round, seat, choices, "seat " + std::to_string(seat));
    transaction.commit();
    return cast;
}

CastBallot BallotStore::vote_within(int id,
                                    int seat,
                                    const Choices& choices,
                                    const std::string& who) {
    const Round round = round_of(database_, id);
    check_choices(choices, round, who);
    const auto seats = database_.run("SELECT 1 FROM seats WHERE session = ?1 AND seat = ?2",
                                     {std::int64_t{round.session}, std::int64_t{seat}});
    check_argument(!seats.empty(), "ballot of " + who + ": found no such seat in the session");
    if (round.closed) {
        throw Refused(round_name(id) + " is closed, so the ballot of " + who + " is too late",
                      "open a new round and vote there");
    }
    if (!round.voting) {
        throw Refused(
            round_name(id) + " is still presented, so the ballot of " + who + " is too early",
            "vote when all looks have been shown");
    }
    if (const Turn turn = turn_of(id, seat); !turn.votes) {
        throw Refused("the ballot of " + who + " is too early: its turn comes with group " +
                          std::to_string(turn.wave + 1) + " of " + std::to_string(turn.waves),
                      "vote when that group has seen all looks");
    }
    if (const auto present = ballot_at(database_, round, seat);
        present && present->choices == choices) {
        return *present;
    }
    record(database_,
           {.what = What::vote,
            .session = round.session,
            .round = id,
            .seat = seat,
            .at = utc_now(),
            .best = choices.best,
            .second = choices.second,
            .least = choices.least.value_or(-1)});
    return *ballot_at(database_, round, seat);
}

std::optional<CastBallot> BallotStore::ballot_of(int round, int seat) const {
    return ballot_at(database_, round_of(database_, round), seat);
}

std::vector<int> BallotStore::voted(int id) const {
    const Round round = round_of(database_, id);
    std::vector<int> seats;
    for (const auto& row :
         database_.run("SELECT seat FROM ballots WHERE session = ?1 AND round = ?2 ORDER BY seat",
                       {std::int64_t{round.session}, std::int64_t{id}})) {
        seats.push_back(as_int(database_, row[0]));
    }
    return seats;
}

std::vector<CastBallot> BallotStore::ballots(int id) const {
    const Round round = round_of(database_, id);
    if (!round.closed) {
        throw Refused(round_name(id) + " is open: votes told now would sway those to come",
                      "close the round, then ask for its ballots");
    }
    check_told(round);
    std::vector<CastBallot> ballots;
    for (const auto& row :
         database_.run(std::string(kBallotColumns) + "WHERE ballots.session = ?1 AND "
                                                     "ballots.round = ?2 ORDER BY ballots.seat",
                       {std::int64_t{round.session}, std::int64_t{id}})) {
        ballots.push_back(ballot_from(database_, row));
    }
    return ballots;
}

Tally BallotStore::tally(int id) const {
    const Round round = round_of(database_, id);
    if (!round.closed) {
        throw Refused(round_name(id) + " is open: counts told now would sway the votes to come",
                      "close the round, then ask for its tally");
    }
    check_told(round);
    Tally tally;
    tally.designs = round.designs;
    tally.best.resize(round.designs.size());
    tally.second.resize(round.designs.size());
    if (round.asks_least) tally.least.resize(round.designs.size());
    for (const CastBallot& ballot : ballots(id)) {
        ++tally.best[static_cast<std::size_t>(ballot.choices.best)];
        ++tally.second[static_cast<std::size_t>(ballot.choices.second)];
        if (ballot.choices.least) ++tally.least[static_cast<std::size_t>(*ballot.choices.least)];
    }
    return tally;
}

std::int64_t BallotStore::others_changes() const {
    const auto rows = database_.run("PRAGMA data_version");
    const auto* count = std::get_if<std::int64_t>(&rows.at(0).at(0));
    return count ? *count : 0;
}

}  // namespace livery
