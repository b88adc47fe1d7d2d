// Folders of photographs without a manifest: which shows which picture, by what they show.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/captures_folder.h"
#include "core/progress.h"

namespace livery {

/// read_captures_folder(). Where there is no manifest.json, the order of the files' names is
/// checked at some of the photographs, and where it does not hold, all are looked at (identify())
/// and get the roles that they show; `warnings` then names those that are out of order, or those
/// that show none of the pictures. Throws FileError, Refused, Cancelled.
CapturesFolder read_shown_captures(const std::filesystem::path& folder,
                                   PhotographUse use,
                                   const std::filesystem::path& patterns_manifest,
                                   std::vector<std::string>& warnings,
                                   const Progress& progress = {});

}  // namespace livery
