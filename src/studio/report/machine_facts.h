// What the program runs on, for a problem report. Every function answers with lines of text, ended
// with a line break, and asks nothing that may take long, unless it says so.
#pragma once

#include <string>

#include "gl/context.h"

namespace livery {

/// Livery's version, what built it, and the libraries that are loaded in this process.
std::string version_facts();

/// Processor, memory, disk, graphics hardware, distribution, desktop session, and the variables of
/// the environment that programs like this one heed.
std::string machine_facts();

/// OpenGL without a window, as the command line draws with it. May crash or hang with the driver:
/// to be asked in a process of its own. Throws std::runtime_error.
std::string opengl_facts(GlDevice device);

/// Monitors, what would spoil a projection on each, and OpenGL of a window. Main thread; the same
/// holds. Throws std::runtime_error where there is no display.
std::string display_facts();

/// Cameras that are found, with what keeps them from being used. The same holds. Throws
/// CameraFault.
std::string camera_facts();

}  // namespace livery
