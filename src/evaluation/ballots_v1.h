// Files of the first format: ballots under names alone, no seats, no codes.
#pragma once

#include <string>
#include <vector>

#include "core/database.h"

namespace livery {

/// The statements that made such a file.
std::vector<std::string> ballots_v1_schema();

/// Makes a file of the newest format of it, within the caller's transaction: one session, a seat a
/// name, codes drawn with seed 1, and the log told anew from the old one, whose last hash it keeps.
/// Throws FileError when the old log's chain is broken or the old tables are not what it leads to.
void migrate_ballots_v1(Database& database);

}  // namespace livery
