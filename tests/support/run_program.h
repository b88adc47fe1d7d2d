// Runs the program as a user does and keeps what it said.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <sys/wait.h>

#include "support/temporary_folder.h"

namespace livery {

struct ProgramRun {
    int exit_code = -1;  ///< 128 + signal when it was killed
    std::string out, err;
};

/// `program` with `arguments`, no standard input.
inline ProgramRun run_program(const std::string& program,
                              const std::vector<std::string>& arguments) {
    const TemporaryFolder folder;
    const auto quoted = [](const std::string& word) {
        std::string safe = "'";
        for (const char c : word) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
        return safe + "'";
    };
    std::string command = quoted(program);
    for (const auto& argument : arguments) command += " " + quoted(argument);
    command += " </dev/null >" + quoted((folder / "out").string()) + " 2>" +
               quoted((folder / "err").string());
    const int status = std::system(command.c_str());
    ProgramRun run;
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    const auto content = [](const std::filesystem::path& file) {
        std::stringstream text;
        text << std::ifstream(file).rdbuf();
        return text.str();
    };
    run.out = content(folder / "out");
    run.err = content(folder / "err");
    return run;
}

}  // namespace livery
