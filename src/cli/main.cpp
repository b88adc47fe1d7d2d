// The program: parses, runs one command, prints its outcome, and turns every failure into one line.

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/parse.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/paths.h"

namespace livery {
namespace {

int fail(int code, const std::string& line) {
    finish_progress_line();
    std::fputs((line + "\n").c_str(), stderr);
    return code;
}

int run(const std::vector<std::string>& arguments) {
    std::vector<Command> commands = {demo_command(),
                                     render_command(),
                                     plan_command(),
                                     patterns_command(),
                                     photograph_command(),
                                     calibrate_color_command(),
                                     compensate_command(),
                                     check_command(),
                                     bench_command()};
    const ParsedCommandLine parsed = parse_command_line(arguments, commands);
    if (!parsed.command) {
        if (parsed.exit_code != 0) return fail(parsed.exit_code, parsed.text);
        std::fputs(parsed.text.c_str(), stdout);
        return 0;
    }
    set_data_folder(parsed.common.data);
    set_thread_count(parsed.common.threads);
    const Outcome outcome = parsed.command->run(parsed.common, console_progress());
    finish_progress_line();
    std::fputs(outcome.text.c_str(), parsed.common.json ? stderr : stdout);
    if (parsed.common.json) std::fputs((outcome.figures.dump(2) + "\n").c_str(), stdout);
    return std::fflush(stdout) == 0 ? outcome.exit_code : fail(2, "stdout: cannot write");
}

}  // namespace
}  // namespace livery

int main(int argc, char** argv) {
    using livery::fail;
    try {
        return livery::run({argv + 1, argv + argc});
    } catch (const livery::Cancelled&) {
        return fail(130, "livery: stopped");
    } catch (const livery::Refused& refused) {
        return fail(1, "livery: refused: " + std::string(refused.what()));
    } catch (const std::exception& error) {
        return fail(2, "livery: " + std::string(error.what()));
    }
}
