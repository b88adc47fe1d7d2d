// What an operator knows of projector and camera, as options.
#pragma once

#include <vector>

#include "cli/command.h"
#include "scene/data_sheet.h"

namespace livery {

/// `sheets` must live as long as the command, with 0 where nothing is given.
void add_data_sheet_options(std::vector<Option>& options, DataSheets& sheets);
bool is_any_given(const DataSheets& sheets);
/// Throws std::invalid_argument that names the first option that is missing; `instead`: what else
/// could be given, for its message.
void check_whole(const DataSheets& sheets, const std::string& instead = "");

}  // namespace livery
