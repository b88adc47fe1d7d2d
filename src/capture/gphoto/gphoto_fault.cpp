#include "capture/gphoto/gphoto_fault.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "capture/gphoto/gphoto_photograph.h"

namespace livery {

std::string programs_with(const std::string& port) {
    if (!port.starts_with("usb:")) return "";
    std::string device = "/dev/bus/usb/" + port.substr(4);
    std::replace(device.begin(), device.end(), ',', '/');
    std::string programs;
    std::error_code error;
    for (std::filesystem::directory_iterator process("/proc", error), end; !error && process != end;
         process.increment(error)) {
        const std::string number = process->path().filename().string();
        if (number.find_first_not_of("0123456789") != std::string::npos ||
            number == std::to_string(::getpid()))
            continue;
        std::error_code hidden;
        for (std::filesystem::directory_iterator open(process->path() / "fd", hidden), last;
             !hidden && open != last;
             open.increment(hidden)) {
            std::error_code gone;
            if (std::filesystem::read_symlink(open->path(), gone) != device || gone) continue;
            std::string name;
            std::getline(std::ifstream(process->path() / "comm"), name);
            programs += (programs.empty() ? "" : ", ") + name + " (" + number + ")";
            break;
        }
    }
    return programs;
}

CameraFault fault_of_gphoto(const std::string& camera,
                            const std::string& port,
                            const GphotoError& error) {
    const auto fault = [&](CameraTrouble trouble, const std::string& why, const char* fix) {
        const bool says_more = error.what != gp_result_as_string(GP_ERROR);
        return CameraFault(
            trouble,
            fmt::format("{}: {}{}", camera, why, says_more ? " (" + error.what + ")" : ""),
            fix);
    };
    std::string said = error.what;
    std::transform(said.begin(), said.end(), said.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    if (error.code == GP_ERROR_NO_SPACE || said.find("store full") != std::string::npos ||
        said.find("storage full") != std::string::npos)
        return fault(CameraTrouble::card_full,
                     "its card is full",
                     "empty the card or put another in; photographs are deleted from it once they "
                     "are here");
    if (error.code == GP_ERROR_IO_USB_CLAIM || error.code == GP_ERROR_IO_LOCK)
        return fault(CameraTrouble::held,
                     "another program has it: " + programs_with(port),
                     "close that program; on a desktop it is often the file manager: eject the "
                     "camera there, or end gvfs-gphoto2-volume-monitor");
    if (error.code == GP_ERROR_CAMERA_BUSY || said.find("busy") != std::string::npos)
        return fault(CameraTrouble::silent,
                     "it is busy",
                     "wait until it has written its photographs, and leave its menus");
    if (error.code == GP_ERROR_TIMEOUT)
        return fault(CameraTrouble::silent,
                     "it does not answer",
                     "wake it, switch its automatic power-off off, and charge its battery");
    if (is_of_the_connection(error.code))
        return fault(CameraTrouble::gone,
                     "it is not there any more",
                     "check its cable, its power and its network; it is looked for again");
    return fault(CameraTrouble::refused,
                 "it refuses",
                 "check its lens cap, focus (manual) and card, and that it is set to be controlled "
                 "by a computer (PTP)");
}

}  // namespace livery
