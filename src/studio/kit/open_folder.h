// Showing a folder in the desktop's own file manager.
#pragma once

#include <filesystem>

namespace livery {

/// Asks xdg-open to; false where there is none. Does not wait for the file manager.
bool open_folder(const std::filesystem::path& folder);

}  // namespace livery
