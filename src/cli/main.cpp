// The program: parses, runs one command, prints its outcome, and turns every failure into one line.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/evaluate/commands.h"
#include "cli/outputs.h"
#include "cli/parse.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/paths.h"
#include "core/utf8.h"

namespace livery {
namespace {

/// One line on stderr, whatever the message brings along (a file name may hold a line break, an
/// argument a megabyte).
int fail(int code, const std::string& message) {
    finish_progress_line();
    constexpr std::size_t longest = 4000;
    std::string line;
    for (const char c : message) {
        const bool gap = c == '\n' || c == ' ';
        if (!gap || line.empty() || line.back() != ' ') line += gap ? ' ' : c;
    }
    std::fputs((printable(line, longest) + "\n").c_str(), stderr);
    return code;
}

/// A closed descriptor would become the next file that is opened, and what is printed would be
/// written into it. Whether the answer has somewhere to go is found before the work.
bool has_standard_streams(bool answers) {
    bool stdout_open = true;
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(descriptor, F_GETFD) != -1) continue;
        stdout_open = stdout_open && descriptor != STDOUT_FILENO;
        if (::open("/dev/null", O_RDWR) != descriptor) return false;
    }
    return stdout_open || !answers;
}

/// Names out of other people's files stand in it: what moves a terminal's cursor does not.
std::string for_terminal(const std::string& text) {
    std::string shown;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of("\n\t", at), text.size());
        shown += printable(std::string_view(text).substr(at, end - at));
        if (end < text.size()) shown += text[end];
        at = end + 1;
    }
    return shown;
}

int print(const std::string& text, int exit_code) {
    const bool written = std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
    return written ? exit_code : fail(2, "livery: stdout: cannot write");
}

int run(const std::vector<std::string>& arguments) {
    std::vector<Command> commands = {desktop_command(),
                                     demo_command(),
                                     render_command(),
                                     plan_command(),
                                     brdf_command(),
                                     albedo_command(),
                                     bssrdf_command(),
                                     paints_command(),
                                     patterns_command(),
                                     board_command(),
                                     photograph_command(),
                                     capture_command(),
                                     calibrate_color_command(),
                                     calibrate_compare_command(),
                                     calibrate_drift_command(),
                                     calibrate_geometry_command(),
                                     calibrate_nudge_command(),
                                     calibrate_register_command(),
                                     calibrate_repose_command(),
                                     calibrate_scan_command(),
                                     measure_brdf_command(),
                                     measure_environment_command(),
                                     measure_profile_command(),
                                     fit_brdf_command(),
                                     fit_bssrdf_command(),
                                     compensate_command(),
                                     evaluate_export_command(),
                                     evaluate_order_command(),
                                     evaluate_report_command(),
                                     evaluate_serve_command(),
                                     evaluate_tally_command(),
                                     evaluate_vote_command(),
                                     check_command(),
                                     report_problem_command(),
                                     bench_command()};
    for (Command& command : session_commands()) commands.push_back(std::move(command));
    const ParsedCommandLine parsed = parse_command_line(arguments, commands);
    if (!parsed.command) {
        return parsed.exit_code != 0 ? fail(parsed.exit_code, parsed.text) : print(parsed.text, 0);
    }
    check_outputs(*parsed.command);
    set_data_folder(parsed.common.data);
    set_thread_count(parsed.common.threads);
    Outcome outcome;
    try {
        outcome = parsed.command->run(parsed.common, console_progress());
    } catch (const Refused& refused) {
        if (!parsed.common.json) throw;
        outcome.figures = {{"refused", {{{"why", refused.why()}, {"fix", refused.fix()}}}}};
        outcome.text = "livery: refused: " + std::string(refused.what()) + "\n";
        outcome.exit_code = 1;
    }
    finish_progress_line();
    const std::string text = for_terminal(outcome.text);
    if (!parsed.common.json) return print(text, outcome.exit_code);
    std::fputs(text.c_str(), stderr);
    // A file's name need not be UTF-8.
    return print(outcome.figures.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
                 outcome.exit_code);
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    using livery::fail;
    try {
        const std::vector<std::string> arguments(argv + 1, argv + argc);
        const bool desktop = arguments.empty() || arguments[0] == "desktop";
        if (!livery::has_standard_streams(!desktop)) {
            return fail(2, "livery: stdout: found it closed, expected somewhere to write to");
        }
        return livery::run(arguments);
    } catch (const livery::Cancelled&) {
        return fail(130, "livery: stopped");
    } catch (const livery::Refused& refused) {
        return fail(1, "livery: refused: " + std::string(refused.what()));
    } catch (const std::bad_alloc&) {
        return fail(2,
                    "livery: found no memory left for what the files ask for, expected smaller "
                    "ones, or a machine with more");
    } catch (const std::exception& error) {
        return fail(2, "livery: " + std::string(error.what()));
    }
}
