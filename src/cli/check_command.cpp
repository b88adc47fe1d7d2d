// livery check

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "cli/capture_options.h"
#include "cli/command.h"
#include "jobs/file_check.h"

namespace livery {

Command check_command() {
    struct Arguments {
        std::vector<std::string> files;
        std::string patterns;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "check";
    command.summary = "open files of any kind the program reads, and say what is wrong with them";
    command.example = "livery check car.glb paint.json captures/";
    command.options = {{"files", "FILE...", "files or folders", &arguments->files, true},
                       patterns_option(arguments->patterns)};
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        Outcome outcome;
        Json list = Json::array();
        double done = 0.0;
        const std::vector<std::string>& files = arguments->files;
        for (const std::string& file : files) {
            progress.update(done / static_cast<double>(files.size()), "checking " + file);
            done += 1.0;
            const FileCheck check = check_file(file, progress, arguments->patterns);
            list.push_back({{"file", file},
                            {"kind", check.kind},
                            {"ok", check.ok()},
                            {"problems", check.problems},
                            {"notes", check.notes}});
            outcome.text +=
                fmt::format("{} {}: {}\n", check.ok() ? "ok     " : "PROBLEM", check.kind, file);
            for (const auto& problem : check.problems) outcome.text += "        " + problem + "\n";
            constexpr std::size_t most_notes = 20;
            for (std::size_t k = 0; k < std::min(check.notes.size(), most_notes); ++k) {
                outcome.text += "        note: " + check.notes[k] + "\n";
            }
            if (check.notes.size() > most_notes) {
                outcome.text += fmt::format("        and {} more notes, which --json has\n",
                                            check.notes.size() - most_notes);
            }
            if (!check.ok()) outcome.exit_code = 1;
        }
        outcome.figures = {{"files", list}};
        return outcome;
    };
    return command;
}

}  // namespace livery
