#include "evaluation/ballots_v3.h"

#include <string>

#include "evaluation/ballot_log.h"
#include "evaluation/ballot_tables.h"

namespace livery {

void migrate_ballots_v3(Database& database, int format) {
    check_against_log(database, format);
    const auto entries = read_log(database);
    // No part of the log: who has the QR code on the wall stays welcome.
    const auto invitations =
        database.run("SELECT session, token, code, code_until FROM invitations");
    // --- the old tables go, those that point before those that are pointed at ---
    for (const char* table :
         {"ballots", "designs", "rounds", "seats", "invitations", "sessions", "log"}) {
        database.run(std::string("DROP TABLE ") + table);
    }
    for (const std::string& statement : ballot_tables_schema()) database.run(statement);
    // --- what happened is told again ---
    for (const LogEntry& entry : entries) record(database, entry);
    for (const auto& row : invitations) {
        database.run("INSERT INTO invitations VALUES (?1, ?2, ?3, ?4)", row);
    }
}

}  // namespace livery
