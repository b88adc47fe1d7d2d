// Rows of a ballots file as values, for the parts of its store.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/database.h"
#include "evaluation/ballots.h"

namespace livery {

/// "round 3"
std::string round_name(int round);
/// Rounds that an SQL condition names ("WHERE id = ?1").
std::vector<Round> rounds_where(Database& database,
                                const std::string& condition,
                                const std::vector<DatabaseValue>& values);
/// Throws std::invalid_argument: no such round.
Round round_of(Database& database, int id);

std::optional<int> newest_session(Database& database);
/// Within the caller's transaction.
int make_session(Database& database);

std::optional<int> seat_with_key(Database& database, int session, const std::string& key);
/// The next number of the session, within the caller's transaction; `text` as in LogEntry.
int make_seat(Database& database, int session, const std::string& text, bool phone);
/// The seats that are phones, in rising order.
std::vector<int> phone_seats(Database& database, int session);

}  // namespace livery
