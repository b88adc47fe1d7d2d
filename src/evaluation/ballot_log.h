// What happened to the ballots, in order, each entry sealed with a hash over all before it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/database.h"

namespace livery {

struct LogEntry {
    enum class What {
        open,    ///< `text` is the calibration's id
        design,  ///< `text` is its name, `best` its index
        vote,    ///< `text` is the evaluator
        close
    };
    What what = What::open;
    int round = 0;
    std::string at;  ///< ISO 8601, UTC
    std::string text = {};
    int best = 0, second = 0;
};

/// The statements that make its table and keep it as it is.
std::vector<std::string> log_schema();

/// Appends, within the caller's transaction.
void append_to_log(Database& database, const LogEntry& entry);

/// Throws FileError when an entry was changed, taken out or put in, or when the rounds and ballots
/// are not what the entries lead to. The hash finds accidents and careless hands; somebody who may
/// write the file and knows the program can forge it.
void check_log(Database& database);

/// What a column must hold; FileError otherwise.
int as_int(const Database& database, const DatabaseValue& value);
std::string as_text(const Database& database, const DatabaseValue& value);

}  // namespace livery
