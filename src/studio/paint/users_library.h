// The paint library as the panels see it: looked at again behind the window, never by a frame of
// it.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <vector>

#include "studio/studio.h"

namespace livery {

/// One look at the paint library's files (users_library.h).
struct LibraryReading {
    bool asked = false;
    std::set<std::filesystem::path> files;    ///< that are read as well
    std::vector<std::function<void()>> then;  ///< called when it is done
};

/// The snapshot that the session's names are looked up in.
const PaintLibrary& current_library(const Studio& studio);

/// Looks at the library's files on the background thread and reads `wanted` and the user's measured
/// paints as well; the session goes on with a new snapshot where something is new, and `then` is
/// called on the main thread. When it cannot be read, studio.panels.library->problem says why, and
/// the last good one stays. Called as the window opens, when it gets the focus back (whoever puts a
/// file into the folder comes from another program), and for what is to be drawn and is not read
/// yet; never by a frame or a click that needs nothing new. Files that are being read are not asked
/// for twice.
void refresh_library(Studio& studio,
                     const std::set<std::filesystem::path>& wanted = {},
                     std::function<void()> then = {});

}  // namespace livery
