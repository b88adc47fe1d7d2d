// What the process that faces the network may use, whatever it is told to do.
#pragma once

namespace livery {

/// Limits on data (64 MB), open files, and the size of files; no core file, no child process, no
/// new rights. They hold until the end of the process. Throws std::runtime_error.
void limit_this_process();

/// Ends this process with the one that started it. Throws std::runtime_error.
void end_with_parent();

}  // namespace livery
