// Rounds of votes on looks: who, best, second best, perhaps least. SQLite, one file of their own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/database.h"
#include "evaluation/ballot_log.h"
#include "evaluation/presenting/presentation.h"
#include "evaluation/semantic_scale.h"
#include "evaluation/tally.h"

namespace livery {

/// Indices of the round's designs, all different.
struct Choices {
    int best = 0, second = 0;
    std::optional<int> least = {};
    bool operator==(const Choices&) const = default;
};

/// One that is typed in: in the window, or from paper.
struct Ballot {
    std::string evaluator;     ///< as they want to be called; one ballot each a round
    int best = 0, second = 0;  ///< indices of the round's designs, different
    std::optional<int> least = {};
};

/// A round as one of a series of blind repeats: two looks, shown to one audience several times,
/// each time under other codes.
struct SeriesPlace {
    int series = 0;   ///< the first repeat's round; 0: this is the first
    int repeats = 3;  ///< that are wanted
    int follows = 0;  ///< the locked round whose leaders these are; 0: none
};

struct RoundSetup {
    std::vector<std::string> designs;
    std::string calibration_id = {};  ///< that the designs are shown under; empty: uncorrected
    std::vector<int> codes = {};  ///< a design each, 100 to 999; empty: drawn from seed and round
    int seed = 1;
    bool asks_least = false;
    bool presenting = false;  ///< votes count from start_voting() on; else at once
    /// How it is presented: by this program, which records each step (record_step()). Of all
    /// designs; with `presenting`. One of several sittings without seats has the phones that are in
    /// dealt to them when the round is opened (deal_seats()).
    std::optional<PresentationPlan> plan = {};
    std::optional<SeriesPlace> series = {};
    std::vector<SemanticScale> scales = {};  ///< on which each look may be placed; at most 5
};

struct Series {
    int id = 0;  ///< the first repeat's round
    int session = 0, repeats = 0, follows = 0;
    std::vector<std::string> designs;
    std::vector<int> rounds;  ///< repeats that were voted on and are locked
    /// All repeats are held, or nobody goes on with it: another round or audience has come.
    bool over = false;
};

struct Round {
    int id = 0;
    std::string created;  ///< ISO 8601, UTC
    std::vector<std::string> designs;
    std::string calibration_id;
    bool closed = false;
    int ballots = 0;  ///< how many, all that is told before it is closed
    int session = 0;
    std::vector<int> codes;
    int seed = 1;
    bool asks_least = false;
    std::vector<SemanticScale> scales = {};
    bool voting =
        false;  ///< the looks have been presented; true of closed rounds that were voted on
};

struct Seat {
    int number = 0;
    std::string name;  ///< empty: a phone, of which nothing is known
};

/// When the people of a seat look and vote; who sits in no wave may do so as soon as any may.
struct Turn {
    int wave = 0, waves = 1;
    bool sits = true;   ///< before the mock-up, or has done so
    bool votes = true;  ///< as soon as the round takes votes: its looks have been shown to the wave
    bool operator==(const Turn&) const = default;
};

/// How phones come in: by the token in the QR code, or by eight characters typed in.
struct Invitation {
    std::string token, code;
    std::int64_t code_until_s = 0;  ///< seconds since 1970
};

/// Where one seat places one look on the round's scales: 1 (next to the low word) to 7, a step a
/// scale; nothing where it is left open.
using ScaleSteps = std::vector<std::optional<int>>;

/// All that a seat has answered.
struct CastRatings {
    int seat = 0;
    std::map<int, ScaleSteps> steps;  ///< by design, of those with an answer
};

struct CastBallot {
    int seat = 0;
    Choices choices;
    std::string receipt;  ///< eight hexadecimal digits, the beginning of its log entry's hash
};

/// The statements that make the file (tables, and triggers that keep what is recorded), then those
/// that made files of older formats.
const std::vector<std::string>& ballots_schema();

/// What a function has done is on disk when it returns. Several stores (and programs) may share a
/// file. Throws FileError of the file as Database does, and when the ballots are not what their log
/// says; std::invalid_argument for what makes no sense (unknown round, no such design, same design
/// twice, bad name); Refused, with the fix, for what the round's state forbids.
class BallotStore {
  public:
    /// Opens the file or makes it; reads the whole log and checks it. A file of an older format
    /// becomes one of format 4, in one transaction.
    explicit BallotStore(const std::filesystem::path& file);

    /// A new audience: phones join anew. Refused while a round is open.
    int open_session();
    /// The newest; nothing in an empty file.
    std::optional<int> session() const;
    std::optional<Invitation> invitation(int session) const;
    void invite(int session, const Invitation& invitation);
    /// The seat of the phone with this secret's hash, a new one where it has none. Refused while a
    /// round is open (who joined then would not have seen every look) and when `most_seats` phones
    /// are in.
    int join(int session, const std::string& secret_hash, int most_seats);
    std::optional<int> seat_of_phone(int session, const std::string& secret_hash) const;
    std::vector<Seat> seats(int session) const;

    /// In the newest session, which is made where there is none. At least two designs, all
    /// different. Refused while another round is open.
    int open_round(const RoundSetup& setup);
    int open_round(const std::vector<std::string>& designs, const std::string& calibration_id) {
        return open_round(RoundSetup{designs, calibration_id});
    }
    /// Refused when votes are taken already, and when it is closed.
    void start_voting(int round);
    /// A second ballot of the same evaluator (name_key) replaces the first, while the round is
    /// open; both stay in the log. Refused when it is closed or still presented.
    CastBallot vote(int round, const Ballot& ballot);
    /// All of them or, where one throws, none.
    std::vector<CastBallot> vote(int round, const std::vector<Ballot>& ballots);
    /// The same for a seat, which is also refused while its turn is to come. One that is as the
    /// seat's ballot is already changes nothing.
    CastBallot vote(int round, int seat, const Choices& choices);
    /// Places a look on the round's scales; a step that is left open takes an earlier one back. One
    /// that is as it was changes nothing. Refused as vote() is, and before the seat has voted.
    void rate(int round, int seat, int design, const ScaleSteps& steps);
    /// The seat's own.
    CastRatings ratings_of(int round, int seat) const;
    /// Of all seats that have any, in their order. Refused while the round is open.
    std::vector<CastRatings> ratings(int round) const;
    /// For good. Refused when it is closed already.
    void close_round(int round);

    /// What the audience sees from now on, and what led there. Voting begins and ends with it: a
    /// state that votes starts the voting, one that is locked or `abort` closes the round. Refused
    /// for a round without a plan.
    void record_step(int round, const PresentationState& state, PresentationEvent event);
    /// Nothing for a round that was opened without one.
    std::optional<PresentationPlan> plan_of(int round) const;
    Turn turn_of(int round, int seat) const;
    /// All steps of a round with their times: the order in which its looks were shown.
    std::vector<PresentationStep> steps_of(int round) const;
    /// The newest round with a plan whose presentation has not ended, and where it stands.
    struct Presented {
        Round round;
        PresentationPlan plan;
        PresentationStep step;
    };
    std::optional<Presented> presented() const;

    /// Nothing for a round that is no repeat.
    std::optional<Series> series_of(int round) const;
    std::optional<Series> series_under_way() const;

    std::vector<Round> rounds() const;
    std::optional<Round> open_round() const;
    /// The newest round of a session.
    std::optional<Round> last_round(int session) const;
    std::optional<CastBallot> ballot_of(int round, int seat) const;
    /// The seats that have voted, never for what.
    std::vector<int> voted(int round) const;
    /// In the order of seats. Refused while the round is open, or its series under way.
    std::vector<CastBallot> ballots(int round) const;
    /// Refused while the round is open, or its series under way.
    Tally tally(int round) const;
    const std::filesystem::path& file() const { return database_.file(); }
    /// All that happened, in order.
    std::vector<LogEntry> log() const { return read_log(database_); }
    /// Changes when another program or store has changed the file.
    std::int64_t others_changes() const;

  private:
    CastBallot vote_by_name(int round, const Ballot& ballot);
    CastBallot vote_within(int round, int seat, const Choices& choices, const std::string& who);
    void check_series(const RoundSetup& setup, int session) const;
    void check_told(const Round& round) const;
    mutable Database database_;
};

}  // namespace livery
