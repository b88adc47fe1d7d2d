// What happened to the ballots, in order, each entry sealed with a hash over all before it: the one
// truth of a ballots file.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/database.h"
#include "evaluation/ballot.h"
#include "evaluation/presenting/presentation.h"
#include "evaluation/typed_words.h"

namespace livery {

/// A round as one of a series of blind repeats: two looks, shown to one audience several times,
/// each time under other codes.
struct SeriesPlace {
    int series = 0;   ///< the first repeat's round; 0: this is the first
    int repeats = 3;  ///< that are wanted
    int follows = 0;  ///< the locked round whose leaders these are; 0: none
};

struct LogEntry {
    /// An audience: its seats are kept over rounds.
    struct Session {};
    struct Seat {
        int number = 0;
        bool phone = false;
        std::string who;  ///< a name, or the hash of the phone's secret
    };
    struct Open {
        std::string calibration_id;
        bool asks_least = false;
        int seed = 1;
    };
    struct Design {
        int index = 0;
        std::string name;
        int code = 0;
    };
    struct Scale {
        int index = 0;
        SemanticScale scale;
    };
    /// The round is one of a series; the first repeat's `series` is its own round.
    struct Repeat {
        SeriesPlace place;
    };
    struct Plan {
        PresentationPlan plan;
    };
    /// The looks have been presented.
    struct Voting {};
    /// What the audience sees from now on, and what led there.
    struct Shown {
        PresentationState state;
        PresentationEvent event = PresentationEvent::present;
    };
    struct Vote {
        int seat = 0;
        Ballot ballot;
    };
    /// Where a seat places a look on one scale.
    struct Rating {
        int seat = 0, design = 0, scale = 0;
        int step = 0;  ///< 1 to 7; 0: an answer is taken back
    };
    struct Close {};
    using What = std::variant<Session,
                              Seat,
                              Open,
                              Design,
                              Scale,
                              Repeat,
                              Plan,
                              Voting,
                              Shown,
                              Vote,
                              Rating,
                              Close>;

    int session = 0, round = 0;  ///< 0: of none
    std::string at;              ///< ISO 8601, UTC
    What what;
    int id = 0;             ///< from 1, without gaps
    std::string hash = {};  ///< over it and all before it
};

/// The statements that make the log's table and its seal, and keep the log as it is.
std::vector<std::string> log_schema();

/// How far a log is known: its last entry then.
struct LogSeal {
    int entry = 0;
    std::string hash = {};
    bool operator==(const LogSeal&) const = default;
};
/// What the file says of its own log.
LogSeal seal_of(Database& database);
void seal_log(Database& database, const LogSeal& end);

/// Appends to a log that ends at `end`, within the caller's transaction. Fills in `id` and `hash`,
/// and moves `end` and the file's seal.
void append_to_log(Database& database, LogSeal& end, LogEntry& entry);

/// Every entry after `from`, in order; moves `from` with each. Throws FileError when one was
/// changed, taken out or put in. The hash finds accidents and careless hands; somebody who may
/// write the file and knows the program can forge it. Entry by entry: a log may be larger than the
/// server's memory limit.
void read_log(Database& database, LogSeal& from, const std::function<void(const LogEntry&)>& take);

/// Throws FileError of ballots that are not as Livery wrote them.
[[noreturn]] void fail_ballots(const Database& database, std::string field, std::string found);

}  // namespace livery
