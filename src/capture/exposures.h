// How long photographs were exposed, where their manifest does not say.
#pragma once

#include <filesystem>
#include <vector>

#include "capture/captures_folder.h"

namespace livery {

/// Gives each of a folder's captures without `exposure_s` the exposure time of its file's EXIF.
/// Where neither says: for places that of the others, one second where nobody says anything; for
/// light FileError, which names `manifest` and the field, and so for places where the others
/// differ. Photographs at another ISO or aperture than the rest are Refused by name: their light
/// does not compare by seconds alone.
void complete_exposures(const std::vector<Capture*>& captures,
                        const std::filesystem::path& manifest,
                        PhotographUse use);
/// The same of a list.
void complete_exposures(std::vector<Capture>& captures,
                        const std::filesystem::path& manifest,
                        PhotographUse use);

}  // namespace livery
