#include "studio/report/problem_report.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <link.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "core/error.h"
#include "core/paths.h"
#include "core/system/programs.h"
#include "core/system/version.h"
#include "core/system/zip_file.h"
#include "core/utf8.h"
#include "gl/window.h"
#include "jobs/capture_bench.h"
#include "projection/desktop_watch.h"
#include "projection/monitors.h"
#include "session/session_file.h"
#include "studio/report/redaction.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

/// What stands behind `name` and a colon or an equals sign in the first line that begins with it.
std::string field_of(const Path& file, const std::string& name) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        if (!line.starts_with(name)) continue;
        const std::size_t sign = line.find_first_of(":=", name.size());
        if (sign == std::string::npos || line.find_first_not_of(" \t", name.size()) != sign)
            continue;
        std::string value = line.substr(sign + 1);
        value.erase(0, value.find_first_not_of(" \t\""));
        value.erase(value.find_last_not_of(" \t\"") + 1);
        return value;
    }
    return "not said";
}

std::string first_line_of(const Path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    return line;
}

std::string free_space_text() {
    try {
        Path folder = user_folder();
        while (!std::filesystem::exists(folder) && folder.has_relative_path()) {
            folder = folder.parent_path();
        }
        const auto space = std::filesystem::space(folder);
        return fmt::format("{:.1f} of {:.1f} GB",
                           1e-9 * static_cast<double>(space.available),
                           1e-9 * static_cast<double>(space.capacity));
    } catch (const std::exception& error) {
        return std::string("not found out: ") + error.what();
    }
}

/// Cards as the kernel has them, whatever OpenGL makes of them.
std::string graphics_hardware() {
    std::string text;
    std::error_code error;
    std::vector<Path> cards;
    for (const auto& entry : std::filesystem::directory_iterator("/sys/class/drm", error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("card") && name.find('-') == std::string::npos) {
            cards.push_back(entry.path());
        }
    }
    std::sort(cards.begin(), cards.end());
    for (const Path& card : cards) {
        const auto driver = std::filesystem::read_symlink(card / "device/driver", error);
        text += fmt::format("Graphics hardware: {}, vendor {}, device {}, driver {}\n",
                            card.filename().string(),
                            first_line_of(card / "device/vendor"),
                            first_line_of(card / "device/device"),
                            error ? "none" : driver.filename().string());
    }
    if (const std::string nvidia = first_line_of("/proc/driver/nvidia/version"); !nvidia.empty()) {
        text += nvidia + "\n";
    }
    return text.empty() ? "Graphics hardware: none in /sys/class/drm\n" : text;
}

/// Those that the desktop, OpenGL and this program go by.
std::string environment_facts() {
    constexpr std::array<std::string_view, 23> prefixes = {"DISPLAY=",
                                                           "WAYLAND_DISPLAY=",
                                                           "XDG_SESSION_TYPE=",
                                                           "XDG_CURRENT_DESKTOP=",
                                                           "LANG=",
                                                           "LC_",
                                                           "LIVERY_",
                                                           "LIBGL_",
                                                           "MESA_",
                                                           "GALLIUM_",
                                                           "LP_",
                                                           "EGL_",
                                                           "__EGL_",
                                                           "__GL",
                                                           "__NV",
                                                           "DRI_",
                                                           "vblank_mode=",
                                                           "GDK_SCALE=",
                                                           "QT_SCALE_FACTOR=",
                                                           "OMP_",
                                                           "LD_PRELOAD=",
                                                           "LD_LIBRARY_PATH=",
                                                           "XDG_DATA_HOME="};
    std::set<std::string> found;
    for (char** variable = ::environ; *variable; ++variable) {
        const std::string_view text = *variable;
        for (const std::string_view prefix : prefixes) {
            if (text.starts_with(prefix)) found.emplace(text);
        }
    }
    std::string text;
    for (const std::string& each : found) text += each + "\n";
    return text;
}

int add_library(dl_phdr_info* info, std::size_t, void* list) {
    std::error_code error;
    if (info->dlpi_name && *info->dlpi_name == '/') {
        // The file behind the link has the whole version in its name.
        const auto file = std::filesystem::canonical(info->dlpi_name, error);
        static_cast<std::set<std::string>*>(list)->insert(error ? info->dlpi_name : file.string());
    }
    return 0;
}

std::string lines_of(const Monitor& monitor, DesktopWatch& desktop) {
    std::string text = fmt::format("Monitor {}: {}, {}x{} at {},{}, {:.2f} Hz{}\n",
                                   monitor.number,
                                   monitor.name,
                                   monitor.width,
                                   monitor.height,
                                   monitor.x,
                                   monitor.y,
                                   monitor.refresh_hz,
                                   monitor.primary ? ", the primary one" : "");
    for (const SignalWarning& warning : check_signal(monitor, {0, 0}, desktop)) {
        text += fmt::format("    {} {} {}\n", warning.what, warning.cause, warning.fix);
    }
    return text;
}

/// Livery's version, what built it, and the libraries that are loaded in this process.
std::string version_facts() {
    std::set<std::string> libraries;
    ::dl_iterate_phdr(&add_library, &libraries);
    std::string text = version_text() + "\nBuilt with: " + built_with() + "\n\nLibraries loaded:\n";
    for (const std::string& library : libraries) text += library + "\n";
    return text;
}

/// Processor, memory, disk, graphics hardware, distribution, desktop session, and the variables of
/// the environment that programs like this one heed.
std::string machine_facts() {
    utsname system{};
    ::uname(&system);
    return fmt::format("Processor: {}, {} threads\n",
                       field_of("/proc/cpuinfo", "model name"),
                       std::thread::hardware_concurrency()) +
           "Memory: " + field_of("/proc/meminfo", "MemTotal") + ", available " +
           field_of("/proc/meminfo", "MemAvailable") +
           "\nFree on the disk of the user's folder: " + free_space_text() + "\n" +
           graphics_hardware() + "Distribution: " + field_of("/etc/os-release", "PRETTY_NAME") +
           fmt::format("\nKernel: {} {} {}\n\nEnvironment:\n",
                       system.sysname,
                       system.release,
                       system.machine) +
           environment_facts();
}

/// OpenGL without a window, as the command line draws with it. May crash or hang with the driver:
/// to be asked in a process of its own. Throws std::runtime_error.
std::string opengl_facts(GlDevice device) {
    const HeadlessContext context(device);
    return context_facts();
}

/// Monitors, what would spoil a projection on each, and OpenGL of a window. Main thread; the same
/// holds. Throws std::runtime_error where there is no display.
std::string display_facts() {
    const WindowSystem window_system;
    std::string text;
    DesktopWatch desktop(is_xwayland());
    const std::vector<Monitor> monitors = list_monitors(&desktop);
    for (const Monitor& monitor : monitors) text += lines_of(monitor, desktop);
    if (monitors.empty()) text = "No monitor is lit.\n";
    WindowOptions hidden;
    hidden.size_px = {16, 16};
    hidden.visible = false;
    try {
        Window window(hidden);
        window.make_current();
        text += "\nOpenGL of a window:\n" + context_facts();
    } catch (const std::runtime_error& error) {
        text += std::string("\nOpenGL of a window: ") + error.what() + "\n";
    }
    return text;
}

/// Cameras that are found, with what keeps them from being used. The same holds. Throws
/// CameraFault.
std::string camera_facts() {
    std::string text;
    for (const ListedCamera& camera : list_cameras(false)) {
        text += camera.choice + ": " + camera.name + "\n";
        if (!camera.problem.empty()) text += "    " + camera.problem + ": " + camera.fix + "\n";
        // The driver's own name for it
        if (const std::string number = camera.choice.substr(camera.choice.find(':') + 1);
            camera.choice.starts_with("video:")) {
            text +=
                "    " + first_line_of("/sys/class/video4linux/video" + number + "/name") + "\n";
        }
    }
    return text.empty() ? "No camera is found on USB or as a video device. Network cameras must be "
                          "named, so none is looked for.\n"
                        : text;
}

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
