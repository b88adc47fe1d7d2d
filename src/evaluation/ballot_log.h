// What happened to the ballots, in order, each entry sealed with a hash over all before it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/database.h"

namespace livery {

struct LogEntry {
    enum class What {
        session,   ///< an audience: its seats are kept over rounds
        seat,      ///< `text` is a name, or the hash of a phone's secret; `best` is 1 for a phone
        open,      ///< `text` is the calibration's id, `best` whether the least is asked, `second`
                   ///< the seed
        design,    ///< `text` is its name, `best` its index, `second` its code
        voting,    ///< the looks have been presented
        vote,      ///< indices of designs; `least` is -1 where none is named
        close,     ///< the round is locked
        migrated,  ///< `text` is the last hash of the log of an older file
        plan,      ///< how the round is presented: `text` as text_of(PresentationPlan)
        shown,     ///< what the audience sees from now on: `text` as text_of(PresentationState),
                   ///< `best` the design or -1, `second` its place, `seat` the sitting, `least` 1
                   ///< where the people of that sitting vote
        series,    ///< the round is one of a series of blind repeats: `seat` is the first one's
                   ///< round, `best` how many are wanted, `second` the round that it follows or 0
        scale,     ///< the round asks for it: `text` is the two words with a tab between, `best`
                   ///< its index
        rated      ///< an answer on a scale: `best` the design, `second` the scale, `least` the
                   ///< step from 1, or -1 where an answer is taken back
    };
    What what = What::open;
    int session = 0, round = 0, seat = 0;
    std::string at = {};  ///< ISO 8601, UTC
    std::string text = {};
    int best = 0, second = 0, least = -1;
    int id = 0;             ///< from 1, without gaps; given by append_to_log
    std::string hash = {};  ///< the same
};

/// The statements that make its table and keep it as it is. Format 2 knew no presentations, format
/// 3 neither series nor scales.
std::vector<std::string> log_schema(int format = 4);

/// Appends, within the caller's transaction, and fills in `id` and `hash`.
void append_to_log(Database& database, LogEntry& entry);

/// Every entry, in order. Throws FileError when one was changed, taken out or put in. The hash
/// finds accidents and careless hands; somebody who may write the file and knows the program can
/// forge it. Entry by entry: a log may be larger than the server's memory limit.
void read_log(Database& database, const std::function<void(const LogEntry&)>& take);
std::vector<LogEntry> read_log(Database& database);

/// Throws FileError of ballots that are not as Livery wrote them.
[[noreturn]] void fail_ballots(const Database& database, std::string field, std::string found);

/// What a column must hold; FileError otherwise.
int as_int(const Database& database, const DatabaseValue& value);
std::string as_text(const Database& database, const DatabaseValue& value);

}  // namespace livery
