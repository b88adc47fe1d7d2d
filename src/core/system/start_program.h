// Programs of ours that run beside this one.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

namespace livery {

/// Starts the program beside this one that has this name. `files`: which of this program's open
/// files become its 0, 1 or 2; where 0 is none of them it reads nothing. Throws FileError, with
/// `called` for what the program is.
pid_t start_program(const std::string& name,
                    std::vector<std::string> arguments,
                    const std::vector<std::pair<int, int>>& files,
                    const char* called);

}  // namespace livery
