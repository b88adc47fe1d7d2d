#include "evaluation/ballots.h"

#include <set>

#include "core/error.h"
#include "core/utc.h"
#include "evaluation/ballot_log.h"
#include "evaluation/evaluator_name.h"

namespace livery {

namespace {

constexpr std::int32_t kApplicationId = 0x4c765642;  // "LvVB"
constexpr int kVersion = 1;

std::string round_name(int round) { return "round " + std::to_string(round); }

/// How many designs it has, and whether it is closed. Throws std::invalid_argument: no such round.
struct RoundState {
    int designs = 0;
    bool closed = false;
};
RoundState state_of(Database& database, int round) {
    const auto rows = database.run(
        "SELECT closed IS NOT NULL, (SELECT count(*) FROM designs WHERE round = rounds.id) "
        "FROM rounds WHERE id = ?1",
        {std::int64_t{round}});
    if (rows.empty()) {
        const auto counted = database.run("SELECT count(*) FROM rounds");
        throw std::invalid_argument("found " + round_name(round) + ", expected one of the " +
                                    std::to_string(as_int(database, counted[0][0])) +
                                    " rounds in " + database.file().string());
    }
    return {as_int(database, rows[0][1]), as_int(database, rows[0][0]) != 0};
}

}  // namespace

const std::vector<std::string>& ballots_schema() {
    static const std::vector<std::string> statements = [] {
        std::vector<std::string> all = {
            "CREATE TABLE rounds ("
            " id INTEGER PRIMARY KEY,"
            " created TEXT NOT NULL,"
            " calibration_id TEXT NOT NULL,"
            " closed TEXT) STRICT",
            "CREATE UNIQUE INDEX one_open_round ON rounds (closed IS NULL) WHERE closed IS NULL",
            "CREATE TABLE designs ("
            " round INTEGER NOT NULL REFERENCES rounds (id),"
            " position INTEGER NOT NULL CHECK (position >= 0),"
            " name TEXT NOT NULL CHECK (name <> ''),"
            " PRIMARY KEY (round, position), UNIQUE (round, name)) STRICT, WITHOUT ROWID",
            "CREATE TABLE ballots ("
            " round INTEGER NOT NULL,"
            " name_key TEXT NOT NULL CHECK (name_key <> ''),"
            " evaluator TEXT NOT NULL CHECK (evaluator <> ''),"
            " best INTEGER NOT NULL,"
            " second INTEGER NOT NULL,"
            " at TEXT NOT NULL,"
            " PRIMARY KEY (round, name_key),"
            " CHECK (best <> second),"
            " FOREIGN KEY (round, best) REFERENCES designs (round, position),"
            " FOREIGN KEY (round, second) REFERENCES designs (round, position)"
            ") STRICT, WITHOUT ROWID",
            "CREATE TRIGGER ballot_in_time BEFORE INSERT ON ballots"
            " WHEN (SELECT closed FROM rounds WHERE id = new.round) IS NOT NULL"
            " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
            "CREATE TRIGGER ballot_changed_in_time BEFORE UPDATE ON ballots"
            " WHEN (SELECT closed FROM rounds WHERE id = old.round) IS NOT NULL"
            " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
            "CREATE TRIGGER ballot_kept BEFORE DELETE ON ballots"
            " BEGIN SELECT RAISE(ABORT, 'ballots are not deleted'); END",
            "CREATE TRIGGER round_closed_for_good BEFORE UPDATE ON rounds"
            " WHEN old.closed IS NOT NULL"
            " BEGIN SELECT RAISE(ABORT, 'the round is closed'); END",
        };
        for (std::string& statement : log_schema()) all.push_back(std::move(statement));
        return all;
    }();
    return statements;
}

BallotStore::BallotStore(const std::filesystem::path& file)
    : database_(file, Database::Mode::create, kApplicationId, kVersion, ballots_schema()) {
    database_.run("PRAGMA foreign_keys = ON");
    Transaction transaction(database_);
    if (database_.version() == 0) {
        for (const std::string& statement : ballots_schema()) database_.run(statement);
        database_.set_version(kVersion);
    }
    check_log(database_);
    transaction.commit();
}

int BallotStore::open_round(const std::vector<std::string>& designs,
                            const std::string& calibration_id) {
    check_argument(designs.size() >= 2,
                   "open_round: found " + std::to_string(designs.size()) +
                       " designs, expected at least 2 to choose between");
    std::set<std::string> names;
    for (const auto& name : designs) {
        check_argument(!name.empty(), "open_round: found a design without a name");
        check_argument(names.insert(name).second,
                       "open_round: found \"" + name + "\" twice, expected different names");
    }
    Transaction transaction(database_);
    if (const auto other = open_round()) {
        throw Refused(round_name(other->id) + " is still open", "close it before opening the next");
    }
    const std::string now = utc_now();
    database_.run("INSERT INTO rounds (created, calibration_id) VALUES (?1, ?2)",
                  {now, calibration_id});
    const int round = as_int(database_, database_.run("SELECT max(id) FROM rounds")[0][0]);
    append_to_log(database_, {LogEntry::What::open, round, now, calibration_id});
    for (std::size_t k = 0; k < designs.size(); ++k) {
        const auto position = static_cast<int>(k);
        database_.run("INSERT INTO designs VALUES (?1, ?2, ?3)",
                      {std::int64_t{round}, std::int64_t{position}, designs[k]});
        append_to_log(database_, {LogEntry::What::design, round, now, designs[k], position});
    }
    transaction.commit();
    return round;
}

void BallotStore::vote(int round, const Ballot& ballot) {
    const std::string name = tidy_name(ballot.evaluator), key = name_key(ballot.evaluator);
    check_argument(ballot.best != ballot.second,
                   "ballot of " + name + ": found design " + std::to_string(ballot.best) +
                       " as best and as second best, expected two designs");
    Transaction transaction(database_);
    const RoundState state = state_of(database_, round);
    for (const int design : {ballot.best, ballot.second}) {
        check_argument(design >= 0 && design < state.designs,
                       "ballot of " + name + ": found design " + std::to_string(design) +
                           ", expected 0 to " + std::to_string(state.designs - 1));
    }
    if (state.closed) {
        throw Refused(round_name(round) + " is closed, so the ballot of " + name + " is too late",
                      "open a new round and vote there");
    }
    const std::string now = utc_now();
    database_.run(
        "INSERT INTO ballots VALUES (?1, ?2, ?3, ?4, ?5, ?6) "
        "ON CONFLICT (round, name_key) DO UPDATE SET evaluator = excluded.evaluator, "
        "best = excluded.best, second = excluded.second, at = excluded.at",
        {std::int64_t{round},
         key,
         name,
         std::int64_t{ballot.best},
         std::int64_t{ballot.second},
         now});
    append_to_log(database_, {LogEntry::What::vote, round, now, name, ballot.best, ballot.second});
    transaction.commit();
}

void BallotStore::close_round(int round) {
    Transaction transaction(database_);
    if (state_of(database_, round).closed) {
        throw Refused(round_name(round) + " is closed already", "open a new round to vote again");
    }
    const std::string now = utc_now();
    database_.run("UPDATE rounds SET closed = ?2 WHERE id = ?1", {std::int64_t{round}, now});
    append_to_log(database_, {LogEntry::What::close, round, now});
    transaction.commit();
}

std::vector<Round> BallotStore::rounds() const {
    std::vector<Round> rounds;
    for (const auto& row : database_.run(
             "SELECT id, created, calibration_id, closed IS NOT NULL, "
             "(SELECT count(*) FROM ballots WHERE round = rounds.id) FROM rounds ORDER BY id")) {
        Round round;
        round.id = as_int(database_, row[0]);
        round.created = as_text(database_, row[1]);
        round.calibration_id = as_text(database_, row[2]);
        round.closed = as_int(database_, row[3]) != 0;
        round.ballots = as_int(database_, row[4]);
        // A round's designs never change, so a second look is as good as the first.
        for (const auto& design :
             database_.run("SELECT name FROM designs WHERE round = ?1 ORDER BY position",
                           {std::int64_t{round.id}})) {
            round.designs.push_back(as_text(database_, design[0]));
        }
        rounds.push_back(std::move(round));
    }
    return rounds;
}

std::optional<Round> BallotStore::open_round() const {
    for (auto& round : rounds()) {
        if (!round.closed) return round;
    }
    return std::nullopt;
}

Tally BallotStore::tally(int round) const {
    if (!state_of(database_, round).closed) {
        throw Refused(round_name(round) + " is open: counts told now would sway the votes to come",
                      "close the round, then ask for its tally");
    }
    Tally tally;
    for (const auto& row : database_.run(
             "SELECT name,"
             " (SELECT count(*) FROM ballots b WHERE b.round = d.round AND b.best = d.position),"
             " (SELECT count(*) FROM ballots b WHERE b.round = d.round AND b.second = d.position) "
             "FROM designs d WHERE round = ?1 ORDER BY position",
             {std::int64_t{round}})) {
        tally.designs.push_back(as_text(database_, row[0]));
        tally.best.push_back(as_int(database_, row[1]));
        tally.second.push_back(as_int(database_, row[2]));
    }
    return tally;
}

}  // namespace livery
