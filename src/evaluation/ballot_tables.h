// The tables of a ballots file, written through its log.
#pragma once

#include <string>
#include <vector>

#include "core/database.h"
#include "evaluation/ballot_log.h"

namespace livery {

/// The statements that make an empty file: tables, and triggers that keep what is recorded.
std::vector<std::string> ballot_tables_schema();

/// Appends the entry to the log and does in the tables what it says, within the caller's
/// transaction.
void record(Database& database, LogEntry entry);

/// Throws FileError when the log's chain is broken, or when the tables are not what it leads to.
/// `format`: that of the file.
void check_against_log(Database& database, int format = 4);

/// What makes a seat one: a name in any spelling (name_key), or a phone's secret, hashed.
std::string named_seat_key(const std::string& name);
std::string phone_seat_key(const std::string& secret_hash);

}  // namespace livery
