// A calibration baked for one design white, kept: reading its planes again, checking and baking
// them takes over a second, a third of which goes into loading a library.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "live/projector_setup.h"

namespace livery {

/// Of all that load_setup() reads, of the percentile and of the pixels that count. Throws FileError
/// for a folder or a file in it that cannot be read.
std::string setup_cache_name(const std::filesystem::path& calibration,
                             double design_white_percentile,
                             GamutMapping gamut,
                             const Image8& mockup);

/// All but the view. Nothing when it is not kept (core/cache.h).
std::shared_ptr<ProjectorSetup> read_kept_setup(const std::string& name);
void keep_setup(const std::string& name, const ProjectorSetup& setup);

}  // namespace livery
