// The command line as a whole: which command, its options, and what goes wrong with them.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"

namespace livery {

struct ParsedCommandLine {
    CommonOptions common;
    Command* command = nullptr;  ///< null: `text` is to be printed and nothing else done
    std::string text;            ///< help, version, or the one line that says what is wrong
    int exit_code = 0;
};

/// Fills the chosen command's bound variables.
ParsedCommandLine parse_command_line(const std::vector<std::string>& arguments,
                                     std::vector<Command>& commands);

/// The text of `livery help` (`name` empty) or `livery help NAME`; empty when there is no NAME.
std::string help_text(const std::vector<Command>& commands, const std::string& name);

/// What every command takes, bound to `common`.
std::vector<Option> common_options(CommonOptions& common);

/// livery(1) in the man macros: every command with its options, files, environment, exit status.
std::string man_page(const std::vector<Command>& commands);

}  // namespace livery
