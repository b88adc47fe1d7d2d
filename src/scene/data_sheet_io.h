// Data sheets in JSON files.
#pragma once

#include "core/json.h"
#include "scene/data_sheet.h"

namespace livery {

/// Throws FileError where a field is missing or beyond what is built.
DataSheets read_data_sheets(const JsonReader& json);
Json json_of(const DataSheets& sheets);

}  // namespace livery
