// livery report-problem

#include <ctime>
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "session/session.h"
#include "studio/report/problem_report.h"
#include "studio/report/redaction.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

struct ProblemArguments {
    std::string out, session, show;
    bool with_pictures = false, with_votes = false;
};

Path session_to_tell_of(const std::string& given) {
    std::error_code error;
    if (!given.empty()) {
        if (!std::filesystem::is_regular_file(given, error)) {
            throw FileError(given, "--session", "no such file", "a session");
        }
        return given;
    }
    try {
        const Path file = default_session_file();
        return std::filesystem::exists(file, error) ? file : Path();
    } catch (const FileError&) {
        return {};  // no user's folder; the parts that need one say so
    }
}

Outcome shown(const std::string& of, GlDevice device) {
    Outcome outcome;
    outcome.text = redacted(device_facts(of, device), private_words());
    outcome.figures = {{"show", of}, {"text", outcome.text}};
    return outcome;
}

Outcome told(const Path& out, const std::vector<ReportFile>& report) {
    Outcome outcome;
    std::error_code error;
    outcome.figures = {{"file", out.string()},
                       {"bytes", std::filesystem::file_size(out, error)},
                       {"files", Json::array()}};
    for (const ReportFile& file : report) {
        outcome.figures["files"].push_back(
            {{"name", file.name},
             {"what", file.what},
             {"bytes", file.bytes.size()},
             {"problem", file.problem.empty() ? Json(nullptr) : Json(file.problem)}});
        outcome.text += fmt::format("{:<28} {}\n", file.name, file.what);
        if (!file.problem.empty()) outcome.text += "    missing in it: " + file.problem + "\n";
    }
    outcome.text += "\n" + out.string() +
                    " is written, and nothing is sent. Read it before you send it to anybody.\n";
    return outcome;
}

}  // namespace

Command report_problem_command() {
    const auto arguments = std::make_shared<ProblemArguments>();
    Command command;
    command.name = "report-problem";
    command.summary = "write what helps to find a fault into one archive, to be read and then sent";
    command.example = "livery report-problem --out report.zip";
    command.options = {
        {"--out",
         "FILE",
         "the archive, .zip (default: livery-report-DATE-TIME.zip here)",
         &arguments->out},
        {"--session",
         "FILE",
         "put this session into it (default: of the session in your folder the calibration alone)",
         &arguments->session},
        {"--with-pictures",
         "",
         "put the calibration's pictures into it, and with --session those of artwork",
         &arguments->with_pictures},
        {"--with-votes",
         "",
         "put the ballots of closed rounds into it, without names",
         &arguments->with_votes},
        {"--show",
         "WHAT",
         "print what it would say of this, and write nothing",
         &arguments->show,
         false,
         {"opengl", "display", "cameras"}},
    };
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        if (!arguments->show.empty()) return shown(arguments->show, common.gl_device());
        const std::time_t now = std::time(nullptr);
        const Path out = arguments->out.empty() ? report_name(now) : arguments->out;
        check_argument(out.extension() == ".zip",
                       "--out: found \"" + out.string() + "\", expected a name that ends in .zip");
        ReportRequest request;
        request.session = session_to_tell_of(arguments->session);
        request.with_session = !arguments->session.empty();
        request.with_pictures = arguments->with_pictures;
        request.with_votes = arguments->with_votes;
        const auto devices = ask_devices(common.gl_device(), progress.part(0.0, 0.7));
        const auto report = make_problem_report(request, devices, progress.part(0.7, 1.0));
        write_problem_report(out, report, now);
        return told(out, report);
    };
    return command;
}

}  // namespace livery
