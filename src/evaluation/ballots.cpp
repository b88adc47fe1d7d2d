#include "evaluation/ballots.h"

#include <algorithm>

#include "core/error.h"
#include "core/paths.h"
#include "core/time.h"
#include "evaluation/presentation_order.h"
#include "evaluation/typed_words.h"

namespace livery {

namespace {

constexpr std::int32_t kApplicationId = 0x4c765642;  // "LvVB"
constexpr int kVersion = 5;

/// How phones come in; nothing of it is a vote, and it changes while they do.
constexpr const char* kInvitations =
    "CREATE TABLE invitations ("
    " session INTEGER PRIMARY KEY,"
    " token TEXT NOT NULL,"
    " code TEXT NOT NULL,"
    " code_until INTEGER NOT NULL) STRICT";

// --- format 4, which kept what its log says a second time ---

constexpr const char* kRetiredTables[] = {"ballots",
                                          "designs",
                                          "ratings",
                                          "rounds",
                                          "scales",
                                          "seats",
                                          "series",
                                          "sessions",
                                          "sitters",
                                          "waves"};
constexpr const char* kChangedTables[] = {
    "CREATE TABLE log ("
    " id INTEGER PRIMARY KEY,"
    " at TEXT NOT NULL,"
    " what TEXT NOT NULL CHECK (what IN ('session', 'seat', 'open', 'design', 'voting', 'vote',"
    " 'close', 'migrated', 'plan', 'shown', 'series', 'scale', 'rated')),"
    " session INTEGER NOT NULL,"
    " round INTEGER NOT NULL,"
    " seat INTEGER NOT NULL,"
    " text TEXT NOT NULL,"
    " best INTEGER NOT NULL,"
    " second INTEGER NOT NULL,"
    " least INTEGER NOT NULL,"
    " hash TEXT NOT NULL UNIQUE) STRICT",
    "CREATE TABLE invitations ("
    " session INTEGER PRIMARY KEY REFERENCES sessions (id),"
    " token TEXT NOT NULL,"
    " code TEXT NOT NULL,"
    " code_until INTEGER NOT NULL) STRICT"};

/// Its log has no seal; the tables say whether the end is missing.
void check_end(Database& database, const BallotBooks& books) {
    int closed = 0, seats = 0;
    for (const auto& round : books.rounds) closed += round.round.closed() ? 1 : 0;
    for (const auto& session : books.sessions) seats += static_cast<int>(session.size());
    const auto found = database.run(
        "SELECT max((SELECT coalesce(max(entry), 0) FROM ballots),"
        " (SELECT coalesce(max(entry), 0) FROM ratings)) <= ?1 AND"
        " (SELECT count(*) FROM sessions) = ?2 AND (SELECT count(*) FROM seats) = ?3 AND"
        " (SELECT count(*) FROM rounds) = ?4 AND (SELECT count(closed) FROM rounds) = ?5",
        {std::int64_t{books.end.entry},
         static_cast<std::int64_t>(books.sessions.size()),
         std::int64_t{seats},
         static_cast<std::int64_t>(books.rounds.size()),
         std::int64_t{closed}});
    if (found.at(0).at(0) == DatabaseValue(std::int64_t{1})) return;
    fail_ballots(database, "log", "another end than its tables have");
}

void make_tables(Database& database) {
    for (const std::string& statement : log_schema()) database.run(statement);
    database.run(kInvitations);
}

/// The same log, entry by entry and hash by hash; who has the QR code on the wall stays welcome.
void rebuild_tables(Database& database) {
    for (const char* event : {"UPDATE", "DELETE"}) {
        database.run(std::string("DROP TRIGGER IF EXISTS log_without_") + event);
    }
    for (const char* table : {"log", "invitations"}) {
        database.run(std::string("ALTER TABLE ") + table + " RENAME TO old_" + table);
    }
    make_tables(database);
    for (const char* table : {"log", "invitations"}) {
        database.run(std::string("INSERT INTO ") + table + " SELECT * FROM old_" + table);
        database.run(std::string("DROP TABLE old_") + table);
    }
    for (const char* table : kRetiredTables) database.run(std::string("DROP TABLE ") + table);
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

/// Throws FileError for an entry that Livery would not have written.
void read_into(BallotBooks& books, Database& database) {
    read_log(database, books.end, [&](const LogEntry& entry) {
        try {
            apply(books, entry);
        } catch (const std::exception& error) {
            fail_ballots(database, "log entry " + std::to_string(entry.id), error.what());
        }
    });
}

}  // namespace

const std::vector<std::string>& ballots_schema() {
    static const std::vector<std::string> statements = [] {
        std::vector<std::string> all = log_schema();
        all.emplace_back(kInvitations);
        all.insert(all.end(), std::begin(kChangedTables), std::end(kChangedTables));
        all.insert(all.end(), std::begin(kRetiredTables), std::end(kRetiredTables));
        return all;
    }();
    return statements;
}

/// A transaction that begins with what is in the log now. The books hold what was added until it
/// ends without commit().
class BallotStore::Writing {
  public:
    explicit Writing(BallotStore& store) : store_(store), transaction_(store.database_) {
        store.books();
        begin_ = books().end.entry;
    }
    ~Writing() {
        if (!done_ && books().end.entry != begin_) store_.books_ = {};
    }
    Writing(const Writing&) = delete;
    Writing& operator=(const Writing&) = delete;

    const BallotBooks& books() const { return store_.books_; }
    int newest_session() const { return static_cast<int>(books().sessions.size()); }
    const Round& round(int id) const { return books().round(id).round; }

    void add(int session, int round, LogEntry::What what, std::string at = utc_now()) {
        LogEntry entry{session, round, std::move(at), std::move(what)};
        LogSeal end = books().end;
        append_to_log(store_.database_, end, entry);
        apply(store_.books_, entry);
        store_.books_.end = end;
    }
    void add(const Round& round, LogEntry::What what, std::string at = utc_now()) {
        add(round.session, round.id, std::move(what), std::move(at));
    }
    int add_session() {
        add(newest_session() + 1, 0, LogEntry::Session{});
        return newest_session();
    }
    int add_seat(int session, bool phone, const std::string& who) {
        const int seat = static_cast<int>(books().seats(session).size()) + 1;
        add(session, 0, LogEntry::Seat{seat, phone, who});
        return seat;
    }
    void commit() {
        transaction_.commit();
        done_ = true;
    }

  private:
    BallotStore& store_;
    Transaction transaction_;
    int begin_ = 0;
    bool done_ = false;
};

BallotStore::BallotStore(const std::filesystem::path& file)
    : database_(
          kept_private(file), Database::Mode::create, kApplicationId, kVersion, ballots_schema()) {
    Transaction transaction(database_);
    const int version = database_.version();
    if (version != 0 && version != 4 && version != kVersion) {
        throw FileError(file, "user_version", std::to_string(version), "4 or 5");
    }
    if (version == 0) make_tables(database_);
    read_into(books_, database_);
    if (version == 4) {
        check_end(database_, books_);
        rebuild_tables(database_);
    }
    if (version != kVersion) {
        seal_log(database_, books_.end);
        database_.set_version(kVersion);
    } else if (seal_of(database_) != books_.end) {
        fail_ballots(database_, "log", "another last entry than was sealed");
    }
    transaction.commit();
}

const BallotBooks& BallotStore::books() const {
    read_into(books_, database_);
    return books_;
}

// --- audiences ---

int BallotStore::open_session() {
    Writing writing(*this);
    const int session = writing.add_session();
    writing.commit();
    return session;
}

std::optional<int> BallotStore::session() const {
    const auto newest = static_cast<int>(books().sessions.size());
    return newest == 0 ? std::nullopt : std::optional(newest);
}

std::optional<Invitation> BallotStore::invitation(int session) const {
    const auto rows =
        database_.run("SELECT token, code, code_until FROM invitations WHERE session = ?1",
                      {std::int64_t{session}});
    if (rows.empty()) return std::nullopt;
    return Invitation{std::get<std::string>(rows[0][0]),
                      std::get<std::string>(rows[0][1]),
                      std::get<std::int64_t>(rows[0][2])};
}

void BallotStore::invite(int session, const Invitation& invitation) {
    database_.run(
        "INSERT OR REPLACE INTO invitations VALUES (?1, ?2, ?3, ?4)",
        {std::int64_t{session}, invitation.token, invitation.code, invitation.code_until_s});
}

int BallotStore::join(int session, const std::string& secret_hash, int most_seats) {
    Writing writing(*this);
    const BallotBooks& books = writing.books();
    if (const int seat = books.seat_with_key(session, phone_seat_key(secret_hash))) return seat;
    if (session != writing.newest_session()) {
        throw Refused("this session is over", "join the one that is shown now");
    }
    if (const Round* round = books.open_round()) {
        throw Refused(round_name(round->id) + " has begun", "join before the next round");
    }
    const auto& seats = books.seats(session);
    const auto phones =
        std::count_if(seats.begin(), seats.end(), [](const auto& seat) { return seat.is_phone(); });
    if (phones >= most_seats) {
        throw Refused("all " + std::to_string(most_seats) + " seats are taken",
                      "ask the operator for more, or for a ballot on paper");
    }
    const int seat = writing.add_seat(session, true, secret_hash);
    writing.commit();
    return seat;
}

std::optional<int> BallotStore::seat_of_phone(int session, const std::string& secret_hash) const {
    const int seat = books().seat_with_key(session, phone_seat_key(secret_hash));
    return seat == 0 ? std::nullopt : std::optional(seat);
}

std::vector<Seat> BallotStore::seats(int session) const {
    std::vector<Seat> seats;
    for (const auto& seat : books().seats(session)) {
        seats.push_back({static_cast<int>(seats.size()) + 1, seat.name});
    }
    return seats;
}

// --- rounds ---

int BallotStore::open_round(const RoundSetup& setup) {
    const std::size_t designs = setup.designs.size();
    check_argument(designs >= 2,
                   "open_round: found " + std::to_string(designs) +
                       " designs, expected at least 2 to choose between");
    check_argument(!setup.plan || setup.presenting,
                   "open_round: found a plan for a round that votes at once");
    check_argument(setup.codes.empty() || setup.codes.size() == designs,
                   "open_round: found " + std::to_string(setup.codes.size()) + " codes for " +
                       std::to_string(designs) + " designs, expected one each");
    Writing writing(*this);
    const int session = std::max(writing.newest_session(), 1);
    if (writing.newest_session() == 0) writing.add_session();
    const int round = static_cast<int>(writing.books().rounds.size()) + 1;
    const auto codes =
        setup.codes.empty()
            ? draw_codes(static_cast<int>(designs), static_cast<std::uint64_t>(setup.seed), round)
            : setup.codes;
    const std::string now = utc_now();
    const auto add = [&](LogEntry::What what) {
        writing.add(session, round, std::move(what), now);
    };
    add(LogEntry::Open{setup.calibration_id, setup.asks_least, setup.seed});
    for (std::size_t k = 0; k < designs; ++k) {
        add(LogEntry::Design{static_cast<int>(k), setup.designs[k], codes[k]});
    }
    for (std::size_t k = 0; k < setup.scales.size(); ++k) {
        add(LogEntry::Scale{static_cast<int>(k), setup.scales[k]});
    }
    if (setup.series) {
        SeriesPlace place = *setup.series;
        if (place.series == 0) place.series = round;
        add(LogEntry::Repeat{place});
    }
    if (!setup.presenting) add(LogEntry::Voting{});
    if (setup.plan) {
        PresentationPlan dealt = *setup.plan;
        std::vector<int> phones;
        for (const Seat& seat : seats(session)) {
            if (seat.name.empty()) phones.push_back(seat.number);
        }
        if (dealt.sittings.size() > 1 && dealt.seats.empty() && !phones.empty()) {
            dealt.seats = deal_seats(phones, static_cast<int>(dealt.sittings.size()));
        }
        add(LogEntry::Plan{dealt});
    }
    writing.commit();
    return round;
}

void BallotStore::start_voting(int id) {
    Writing writing(*this);
    writing.add(writing.round(id), LogEntry::Voting{});
    writing.commit();
}

void BallotStore::close_round(int id) {
    Writing writing(*this);
    writing.add(writing.round(id), LogEntry::Close{});
    writing.commit();
}

void BallotStore::record_step(int id, const PresentationState& state, PresentationEvent event) {
    Writing writing(*this);
    const Round& round = writing.round(id);
    // Votes count from here on, before anybody is told that they do.
    if (state.phase == PresentationPhase::voting && !round.voting() && !round.closed()) {
        writing.add(round, LogEntry::Voting{});
    }
    const bool ends = state.phase == PresentationPhase::locked || event == PresentationEvent::abort;
    if (ends && !round.closed()) writing.add(round, LogEntry::Close{});
    writing.add(round, LogEntry::Shown{state, event}, utc_now_ms());
    writing.commit();
}

std::vector<Round> BallotStore::rounds() const {
    std::vector<Round> rounds;
    for (const auto& entry : books().rounds) rounds.push_back(entry.round);
    return rounds;
}

Round BallotStore::round(int id) const { return books().round(id).round; }

std::optional<Round> BallotStore::open_round() const {
    const Round* open = books().open_round();
    return open ? std::optional(*open) : std::nullopt;
}

std::optional<Round> BallotStore::last_round(int session) const {
    const auto& rounds = books().rounds;
    const auto found = std::find_if(rounds.rbegin(), rounds.rend(), [&](const auto& entry) {
        return entry.round.session == session;
    });
    return found == rounds.rend() ? std::nullopt : std::optional(found->round);
}

// --- ballots ---

CastBallot BallotStore::vote(int round, int seat, const Ballot& ballot) {
    Writing writing(*this);
    const CastBallot cast = vote_within(writing, round, seat, ballot);
    writing.commit();
    return cast;
}

CastBallot BallotStore::vote(int round, const std::string& evaluator, const Ballot& ballot) {
    return vote(round, {{evaluator, ballot}}).front();
}

std::vector<CastBallot> BallotStore::vote(int id, const NamedBallots& ballots) {
    Writing writing(*this);
    const int session = writing.round(id).session;
    std::vector<CastBallot> cast;
    for (const auto& [evaluator, ballot] : ballots) {
        const std::string name = tidy_name(evaluator);
        int seat = writing.books().seat_with_key(session, named_seat_key(name));
        if (seat == 0) seat = writing.add_seat(session, false, name);
        cast.push_back(vote_within(writing, id, seat, ballot));
    }
    writing.commit();
    return cast;
}

CastBallot BallotStore::vote_within(Writing& writing, int id, int seat, const Ballot& ballot) {
    const auto& entry = writing.books().round(id);
    const auto present = entry.ballots.find(seat);
    const bool same = present != entry.ballots.end() && present->second.ballot == ballot;
    if (!same || entry.round.closed()) writing.add(entry.round, LogEntry::Vote{seat, ballot});
    return entry.ballots.at(seat);
}

void BallotStore::rate(int id, int seat, int design, const ScaleSteps& steps) {
    Writing writing(*this);
    const auto& entry = writing.books().round(id);
    const std::size_t scales = entry.round.scales.size();
    check_argument(scales > 0,
                   "rate: found answers on scales, expected none: " + round_name(id) +
                       " does not ask for them");
    check_argument(steps.size() == scales,
                   "rate: found " + std::to_string(steps.size()) + " steps, expected " +
                       std::to_string(scales) + ", one a scale of " + round_name(id));
    const auto own = entry.ratings.find(seat);
    const bool open = entry.ballots.contains(seat) && !entry.round.closed();
    const ScaleAnswers none(entry.round.designs.size(), ScaleSteps(scales, 0));
    const ScaleAnswers before = own == entry.ratings.end() ? none : own->second;
    for (std::size_t scale = 0; scale < scales; ++scale) {
        const auto at = static_cast<std::size_t>(design);
        const bool same = at < before.size() && before[at][scale] == steps[scale];
        if (same && open) continue;
        writing.add(entry.round,
                    LogEntry::Rating{seat, design, static_cast<int>(scale), steps[scale]});
    }
    writing.commit();
}

std::optional<CastBallot> BallotStore::ballot_of(int round, int seat) const {
    const auto& ballots = books().round(round).ballots;
    const auto found = ballots.find(seat);
    return found == ballots.end() ? std::nullopt : std::optional(found->second);
}

ScaleAnswers BallotStore::ratings_of(int id, int seat) const {
    const auto& entry = books().round(id);
    const auto own = entry.ratings.find(seat);
    if (own != entry.ratings.end()) return own->second;
    return {entry.round.designs.size(), ScaleSteps(entry.round.scales.size(), 0)};
}

std::vector<int> BallotStore::voted(int round) const {
    std::vector<int> seats;
    for (const auto& [seat, ballot] : books().round(round).ballots) seats.push_back(seat);
    return seats;
}

/// What is told before the end would sway who votes after.
void BallotStore::check_told(int id) const {
    if (!books_.round(id).round.closed()) {
        throw Refused(round_name(id) + " is open: votes told now would sway those to come",
                      "close the round, then ask for its ballots");
    }
    const auto series = books_.series_of(id);
    if (!series || series->over) return;
    throw Refused(round_name(id) + " is one of a series of " + std::to_string(series->repeats) +
                      " of which " + std::to_string(series->rounds.size()) +
                      " are locked: what is told now would sway the repeats to come",
                  "lock the last repeat, or give the series up by opening another round");
}

std::vector<CastBallot> BallotStore::ballots(int id) const {
    const auto& entry = books().round(id);
    check_told(id);
    std::vector<CastBallot> ballots;
    for (const auto& [seat, ballot] : entry.ballots) ballots.push_back(ballot);
    return ballots;
}

VoteCounts BallotStore::tally(int id) const {
    std::vector<Ballot> all;
    for (const CastBallot& cast : ballots(id)) all.push_back(cast.ballot);
    const Round& round = books_.round(id).round;
    return count_ballots(all, static_cast<int>(round.designs.size()), round.asks_least);
}

std::map<int, ScaleAnswers> BallotStore::ratings(int id) const {
    books();
    check_told(id);
    return books_.round(id).ratings;
}

// --- presentations and series ---

std::optional<PresentationPlan> BallotStore::plan_of(int round) const {
    return books().round(round).plan;
}

std::vector<PresentationStep> BallotStore::steps_of(int round) const {
    return books().round(round).steps;
}

Turn BallotStore::turn_of(int round, int seat) const { return books().turn_of(round, seat); }

std::optional<BallotStore::Presented> BallotStore::presented() const {
    const auto& rounds = books().rounds;
    const auto found = std::find_if(
        rounds.rbegin(), rounds.rend(), [](const auto& entry) { return entry.plan.has_value(); });
    if (found == rounds.rend()) return std::nullopt;
    Presented presented{found->round, *found->plan, {}};
    PresentationState& state = presented.step.state;
    if (found->steps.empty()) {
        // Killed between the opening and the first step.
        if (found->round.closed()) return std::nullopt;
        state = after(presented.plan, {}, PresentationEvent::present, 0.0);
        return presented;
    }
    presented.step = found->steps.back();
    if (state.phase == PresentationPhase::edit) return std::nullopt;
    // Another program may have locked it, or let people vote.
    if (found->round.closed()) state.phase = PresentationPhase::locked;
    return presented;
}

std::optional<Series> BallotStore::series_of(int round) const { return books().series_of(round); }

std::optional<Series> BallotStore::series_under_way() const {
    const auto& rounds = books().rounds;
    const auto found = std::find_if(
        rounds.rbegin(), rounds.rend(), [](const auto& entry) { return entry.series.has_value(); });
    if (found == rounds.rend()) return std::nullopt;
    auto series = books_.series_of(found->round.id);
    return series->over ? std::nullopt : series;
}

std::vector<LogEntry> BallotStore::log() const {
    std::vector<LogEntry> entries;
    LogSeal from;
    read_log(database_, from, [&](const LogEntry& entry) { entries.push_back(entry); });
    return entries;
}

std::int64_t BallotStore::others_changes() const {
    const auto rows = database_.run("PRAGMA data_version");
    const auto* count = std::get_if<std::int64_t>(&rows.at(0).at(0));
    return count ? *count : 0;
}

}  // namespace livery
