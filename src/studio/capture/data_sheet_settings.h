// The data sheets of the user's projector and camera, kept for the next time.
#pragma once

#include "scene/data_sheet.h"
#include "studio/kit/user_settings.h"

namespace livery {

/// What was typed last; all but the lens shift 0: nothing was.
DataSheets kept_data_sheets(const UserSettings& settings);
void keep_data_sheets(UserSettings& settings, const DataSheets& sheets);

}  // namespace livery
