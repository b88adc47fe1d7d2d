#include "studio/report/machine_facts.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <link.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "core/paths.h"
#include "core/system/version.h"
#include "gl/context_facts.h"
#include "gl/window.h"
#include "jobs/capture_bench.h"
#include "projection/desktop_watch.h"
#include "projection/monitors.h"

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

}  // namespace

std::string version_facts() {
    std::set<std::string> libraries;
    ::dl_iterate_phdr(&add_library, &libraries);
    std::string text = version_text() + "\nBuilt with: " + built_with() + "\n\nLibraries loaded:\n";
    for (const std::string& library : libraries) text += library + "\n";
    return text;
}

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

std::string opengl_facts(GlDevice device) {
    const HeadlessContext context(device);
    return context_facts();
}

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

std::string camera_facts() {
    std::string text;
    for (const ListedCamera& camera : found_cameras()) {
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

}  // namespace livery
