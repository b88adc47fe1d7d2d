// Options of commands that photograph: what is shown, and what an operator knows of projector and
// camera.
#pragma once

#include <string>
#include <vector>

#include "calibration/correspondence/patterns.h"
#include "cli/command.h"
#include "scene/data_sheet.h"

namespace livery {

Option patterns_option(std::string& target);

/// "gray" or "gray-and-phase"; `target` holds the default.
Option places_option(std::string& target);

/// Throws std::invalid_argument for a word that places_option() does not offer.
PlaceCode parse_places(const std::string& text);

/// `sheets` must live as long as the command, with 0 where nothing is given.
void add_data_sheet_options(std::vector<Option>& options, DataSheets& sheets);
bool is_any_given(const DataSheets& sheets);
/// Throws std::invalid_argument that names the first option that is missing; `instead`: what else
/// could be given, for its message.
void check_whole(const DataSheets& sheets, const std::string& instead = "");

}  // namespace livery
