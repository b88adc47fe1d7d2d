// What a ballots file's log leads to, and the rules that each of its entries keeps.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/ballot_log.h"

namespace livery {

struct Round {
    int id = 0;
    std::string created;  ///< ISO 8601, UTC
    std::vector<std::string> designs;
    std::string calibration_id;  ///< that the designs are shown under; empty: uncorrected
    int ballots = 0;             ///< how many, all that is told before it is closed
    int session = 0;
    std::vector<int> codes;
    int seed = 1;
    bool asks_least = false;
    std::vector<SemanticScale> scales = {};
    std::string voting_at = {};  ///< when the looks had been presented; empty: not yet
    std::string closed_at = {};  ///< empty: it is open
    LogSeal lock = {};           ///< the entry that closed it

    bool voting() const { return !voting_at.empty(); }
    bool closed() const { return !closed_at.empty(); }
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

struct CastBallot {
    int seat = 0;
    Ballot ballot;
    std::string receipt;  ///< eight hexadecimal digits, the beginning of its log entry's hash
};

struct Series {
    int id = 0;  ///< the first repeat's round
    int session = 0, repeats = 0, follows = 0;
    std::vector<std::string> designs = {};
    std::vector<int> rounds = {};  ///< repeats that were voted on and are locked
    /// All repeats are held, or nobody goes on with it: another round or audience has come.
    bool over = false;
};

struct BallotBooks {
    struct SeatEntry {
        std::string key;   ///< named_seat_key() or phone_seat_key(): what makes a seat one
        std::string name;  ///< empty: a phone
        bool is_phone() const { return name.empty(); }
    };
    struct RoundEntry {
        Round round;
        std::optional<PresentationPlan> plan;
        std::vector<PresentationStep> steps;
        std::optional<SeriesPlace> series;
        std::map<int, CastBallot> ballots;    ///< by seat
        std::map<int, ScaleAnswers> ratings;  ///< by seat, of those with any
    };
    std::vector<std::vector<SeatEntry>> sessions;  ///< session 1 first, of each seat 1 first
    std::vector<RoundEntry> rounds;                ///< round 1 first
    LogSeal end;                                   ///< the last entry that they hold

    /// Throws std::invalid_argument: no such round, or session.
    const RoundEntry& round(int id) const;
    const std::vector<SeatEntry>& seats(int session) const;
    /// 0: none has it.
    int seat_with_key(int session, const std::string& key) const;
    /// Null: none is open.
    const Round* open_round() const;
    Turn turn_of(int round, int seat) const;
    /// Nothing for a round that is no repeat.
    std::optional<Series> series_of(int round) const;
};

std::string named_seat_key(const std::string& name);  ///< the same in any spelling (name_key)
std::string phone_seat_key(const std::string& secret_hash);

/// "round 3"
std::string round_name(int round);

/// Takes the entry, which comes after all that the books hold, or leaves them as they are and
/// throws: std::invalid_argument for what makes no sense (unknown round, no such design, same
/// design twice, bad name), Refused, with the fix, for what the round's state forbids.
void apply(BallotBooks& books, const LogEntry& entry);

}  // namespace livery
