// Rows of the price of accuracy as JSON.
#pragma once

#include "core/json.h"
#include "ledger/accuracy/rows.h"

namespace livery {

/// A row as it is kept, without its levels. What is infinitely wrong is kept as 1e12.
Json json_of(const AccuracyRow& row);
/// Its index is -1 where this version does not know the effect or its level. Throws FileError for a
/// malformed one.
AccuracyRow read_row(const JsonReader& read);

}  // namespace livery
