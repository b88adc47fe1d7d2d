// Files of the second format, whose log knew no presentations.
#pragma once

#include "core/database.h"

namespace livery {

/// Makes a file of the newest format of it, within the caller's transaction: the same log, entry by
/// entry and hash by hash, in tables that take the entries of presentations too. Throws FileError
/// when the log's chain is broken or the tables are not what it leads to.
void migrate_ballots_v2(Database& database);

}  // namespace livery
