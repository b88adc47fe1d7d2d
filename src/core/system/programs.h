// Programs of ours that run beside this one, and what they print, asked with a time limit.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "core/progress.h"

namespace livery {

/// Starts the program beside this one that has this name. `files`: which of this program's open
/// files become its 0, 1 or 2; where 0 is none of them it reads nothing. Throws FileError, with
/// `called` for what the program is.
pid_t start_program(const std::string& name,
                    std::vector<std::string> arguments,
                    const std::vector<std::pair<int, int>>& files,
                    const char* called);

struct ProgramAnswer {
    std::string text;  ///< what it printed on both streams, as far as it came
    std::string
        problem;  ///< how it failed, a clause: "it gave no answer in 10 s"; empty: it did not
};

/// One program beside this one (start_program()), running from construction on, so that several may
/// be asked at once.
class AskedProgram {
  public:
    /// Never throws: what cannot be started is a problem of the answer.
    AskedProgram(const std::string& name, const std::vector<std::string>& arguments);
    ~AskedProgram();
    AskedProgram(const AskedProgram&) = delete;
    AskedProgram& operator=(const AskedProgram&) = delete;

    /// Waits until it ends. One that takes longer than `limit` from its start, or prints more than
    /// a megabyte, is killed. Once. Throws Cancelled.
    ProgramAnswer answer(std::chrono::milliseconds limit, const Progress& progress = {});

  private:
    std::chrono::steady_clock::time_point started_;
    std::string not_started_;
    pid_t id_ = -1;
    int output_ = -1;
};

}  // namespace livery
