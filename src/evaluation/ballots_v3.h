// Files of the second format, whose log knew no presentations, and of the third, which knew no
// waves of seats, series and scales.
#pragma once

#include "core/database.h"

namespace livery {

/// Makes a file of the newest format of it, within the caller's transaction: the same log, entry by
/// entry and hash by hash, in tables that take what is new too. `format` is 2 or 3. Throws
/// FileError when the log's chain is broken or the tables are not what it leads to.
void migrate_ballots_v3(Database& database, int format);

}  // namespace livery
