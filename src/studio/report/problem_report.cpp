#include "studio/report/problem_report.h"

#include <chrono>
#include <exception>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/paths.h"
#include "core/system/program_answer.h"
#include "core/system/version.h"
#include "core/system/zip_file.h"
#include "core/utf8.h"
#include "session/session_file.h"
#include "studio/report/machine_facts.h"
#include "studio/report/redaction.h"
#include "studio/report/report_log.h"
#include "studio/report/session_parts.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

constexpr auto kDevicesAnswer = std::chrono::seconds(10);

/// What `write` gives; what it throws stands in its place.
ReportFile text_file(const std::string& name,
                     const std::string& what,
                     const std::function<std::string()>& write) {
    ReportFile file{name, what, "", "", true};
    try {
        file.bytes = write();
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        file.problem = error.what();
        file.bytes = "Not found out: " + file.problem + "\n";
    }
    return file;
}

/// Everything in it that can be read is without private words.
void take_out_private_words(ReportFile& file, const PrivateWords& words) {
    for (std::string* text : {&file.name, &file.what, &file.problem})
        *text = redacted(*text, words);
    if (file.is_text) file.bytes = redacted(file.bytes, words);
}

ReportFile readme(const std::vector<ReportFile>& files) {
    std::string text =
        "A problem report of " + version_text().substr(0, version_text().find('\n')) +
        "\n\nIt was written because somebody asked for it. Livery sends nothing: whoever wrote it "
        "reads it,\nand sends it on or does not. The home folder stands in it as ~, the user's "
        "names "
        "as USER and the\nmachine's as HOST.\n\n";
    for (const ReportFile& file : files) {
        text += fmt::format("{}, {} bytes\n    {}\n", file.name, file.bytes.size(), file.what);
        if (!file.problem.empty()) text += "    Missing in it: " + file.problem + "\n";
    }
    return {"README.txt", "What this report is, and what each of its files holds.", text, "", true};
}

/// The document and what became of the attempt to read it.
struct SessionFound {
    std::shared_ptr<const Document> document;
    std::exception_ptr failure;
};

SessionFound document_of(const ReportRequest& request) {
    SessionFound result{request.document, nullptr};
    if (result.document || request.session.empty()) return result;
    try {
        SessionFile file(request.session, SessionFile::Access::read);
        result.document = std::make_shared<const Document>(file.document(file.position()));
    } catch (...) {
        result.failure = std::current_exception();
    }
    return result;
}

/// Null: there is none yet. Throws what kept it from being read.
const Document* document_in(const SessionFound& found) {
    if (found.failure) std::rethrow_exception(found.failure);
    return found.document.get();
}

/// A device's own words, and what kept it from saying more.
ReportFile device_file(const std::string& of,
                       const std::string& what,
                       const ProgramAnswer& answer) {
    ReportFile file{of + ".txt", what, answer.text, answer.problem, true};
    if (!answer.problem.empty()) {
        // What it said last is why.
        std::string_view said = answer.text;
        while (said.ends_with('\n')) said.remove_suffix(1);
        const std::string why(trimmed(said.substr(said.rfind('\n') + 1)));
        if (!why.empty()) file.problem = why + " (" + answer.problem + ")";
        file.bytes += "Not found out: " + answer.problem + "\n";
    }
    take_out_private_words(file, private_words());
    return file;
}

}  // namespace

std::string device_facts(const std::string& of, GlDevice device) {
    if (of == "opengl") return opengl_facts(device);
    if (of == "display") return display_facts();
    if (of == "cameras") return camera_facts();
    throw std::invalid_argument("--show: found \"" + of +
                                "\", expected opengl, display or cameras");
}

std::vector<ReportFile> ask_devices(GlDevice device, const Progress& progress) {
    const char* gl = device == GlDevice::software   ? "software"
                     : device == GlDevice::hardware ? "hardware"
                                                    : "auto";
    const auto ask = [&](const char* of) -> std::vector<std::string> {
        return {"report-problem", "--show", of, "--gl", gl};
    };
    AskedProgram opengl("livery", ask("opengl")), display("livery", ask("display")),
        cameras("livery", ask("cameras"));
    std::vector<ReportFile> files;
    progress.update(0.0, "asking OpenGL");
    files.push_back(device_file("opengl",
                                "OpenGL as it is found without a window.",
                                opengl.answer(kDevicesAnswer, progress)));
    progress.update(0.3, "asking the monitors");
    files.push_back(device_file("display",
                                "Monitors and projector, what would change their picture, and "
                                "OpenGL of a window.",
                                display.answer(kDevicesAnswer, progress)));
    progress.update(0.6, "asking the cameras");
    files.push_back(device_file(
        "cameras", "Cameras that are found.", cameras.answer(kDevicesAnswer, progress)));
    return files;
}

std::vector<ReportFile> make_problem_report(const ReportRequest& request,
                                            const std::vector<ReportFile>& devices,
                                            const Progress& progress) {
    std::vector<ReportFile> files;
    progress.update(0.0, "version and machine");
    files.push_back(text_file("version.txt",
                              "Livery's version, what built it, and the libraries it has loaded.",
                              [] { return version_facts(); }));
    files.push_back(text_file("machine.txt",
                              "Processor, memory, graphics hardware, system, desktop and the "
                              "settings of its environment.",
                              [] { return machine_facts(); }));
    if (!request.drawn_with.empty()) {
        files.push_back(text_file("window.txt", "What the open window is drawn with.", [&] {
            return request.drawn_with + "\n";
        }));
    }
    files.insert(files.end(), devices.begin(), devices.end());
    const SessionFound found = document_of(request);
    progress.update(0.3, "calibration");
    files.push_back(text_file(
        "calibration.txt",
        "Figures of the calibration in use, and whether its files are whole; no pictures.",
        [&] { return calibration_part(document_in(found), progress); }));
    files.push_back(text_file("settings.json", "What the program remembers for every session.", [] {
        const Path file = user_folder() / "desktop.json";
        std::error_code error;
        return std::filesystem::exists(file, error) ? read_text_file(file) : std::string("{}\n");
    }));
    files.push_back(text_file("log.txt",
                              request.with_session
                                  ? "The end of the program's log."
                                  : "The end of the program's log; of changes to the session it "
                                    "says only of which kind they were.",
                              [&] { return log_part(user_folder(), request.with_session); }));
    if (request.with_session) {
        files.push_back(text_file("session.json",
                                  "The session: its looks with their paints, lights and artwork, "
                                  "seats, and names of its files.",
                                  [&] { return session_part(document_in(found)); }));
    }
    if (request.with_pictures) {
        progress.update(0.6, "pictures");
        const Document* document = found.document.get();
        for (ReportFile& file : picture_parts(document, request.with_session, progress)) {
            files.push_back(std::move(file));
        }
        if (request.sent_to_projector)
            files.push_back(sent_picture_part(*request.sent_to_projector));
    }
    if (request.with_votes) {
        progress.update(0.9, "votes");
        for (ReportFile& file : vote_parts(user_folder())) files.push_back(std::move(file));
    }
    const PrivateWords words = private_words();
    for (ReportFile& file : files) take_out_private_words(file, words);
    files.insert(files.begin(), readme(files));
    return files;
}

std::string report_name(std::time_t now) {
    std::tm parts{};
    ::localtime_r(&now, &parts);
    char text[64];
    std::strftime(text, sizeof text, "livery-report-%Y-%m-%d-%H%M%S.zip", &parts);
    return text;
}

void write_problem_report(const std::filesystem::path& file,
                          const std::vector<ReportFile>& report,
                          std::time_t now) {
    std::vector<ZipEntry> entries;
    for (const ReportFile& each : report) entries.push_back({each.name, each.bytes});
    write_text_file(file, zip_of(entries, now));
}

}  // namespace livery
