#include "support/x_server.h"

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <stdexcept>

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

namespace livery {
namespace {

constexpr int start_timeout_s = 60;

/// No input devices (XTEST brings its own), no graphics card, no virtual terminal: it starts the
/// same for root in a container and for a user beside a running desktop.
constexpr const char* configuration = R"(Section "ServerFlags"
    Option "AutoAddDevices" "false"
    Option "AutoEnableDevices" "false"
    Option "AutoAddGPU" "false"
    Option "DontVTSwitch" "true"
EndSection
Section "Device"
    Identifier "device"
    Driver "dummy"
    VideoRam 256000
EndSection
Section "Monitor"
    Identifier "monitor"
    HorizSync 5-1000
    VertRefresh 5-200
EndSection
Section "Screen"
    Identifier "screen"
    Device "device"
    Monitor "monitor"
    DefaultDepth 24
    SubSection "Display"
        Depth 24
        Virtual {} {}
    EndSubSection
EndSection
)";

/// The display number that the server writes once it takes connections; empty when it ends.
std::string number_from(int descriptor) {
    std::string text;
    while (text.empty() || text.back() != '\n') {
        pollfd wait{descriptor, POLLIN, 0};
        if (::poll(&wait, 1, start_timeout_s * 1000) <= 0) return {};
        char letter = 0;
        if (::read(descriptor, &letter, 1) <= 0) return {};
        text += letter;
    }
    text.pop_back();
    return text;
}

/// The connections whose errors are results, and what is done about those of everybody else.
struct ErrorRouting {
    std::mutex mutex;
    std::vector<Display*> ours;
    XErrorHandler others = nullptr;
};

ErrorRouting& error_routing() {
    static ErrorRouting routing;
    return routing;
}

int on_error(Display* display, XErrorEvent* event) {
    auto& routing = error_routing();
    const std::lock_guard lock(routing.mutex);
    if (std::ranges::find(routing.ours, display) != routing.ours.end()) return 0;
    return routing.others ? routing.others(display, event) : 0;
}

}  // namespace

XServer::XServer(glm::ivec2 largest_px) {
    const auto config = folder_.write(
        "xorg.conf", fmt::format(fmt::runtime(configuration), largest_px.x, largest_px.y));
    // /usr/bin/Xorg may be a wrapper that demands a console.
    const char* inside = "/usr/lib/xorg/Xorg";
    const std::string program = ::access(inside, X_OK) == 0 ? inside : "Xorg";
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
    // The child's end must survive exec: a copy without the flag.
    const int written = ::fcntl(ends[1], F_DUPFD, 3);
    ChildOptions options;
    options.arguments = {program,
                         "-displayfd",
                         std::to_string(written),
                         "-config",
                         config.string(),
                         "-logfile",
                         (folder_ / "log").string(),
                         "-noreset",
                         "-novtswitch",
                         "-sharevts",
                         "-nolisten",
                         "tcp"};
    options.output = folder_ / "output";
    options.kept_descriptor = written;
    server_ = std::make_unique<ChildProcess>(options);
    ::close(ends[1]);
    ::close(written);
    const std::string number = number_from(ends[0]);
    ::close(ends[0]);
    if (number.empty()) {
        throw std::runtime_error("the tests' X server (" + program +
                                 ", package xserver-xorg-video-dummy) did not start:\n" + words());
    }
    display_ = ":" + number;
}

std::string XServer::words() const {
    return tail_of(folder_ / "output") + tail_of(folder_ / "log");
}

XClient::XClient(const std::string& display) : display_(XOpenDisplay(display.c_str())) {
    if (!display_) throw std::runtime_error("the tests' X server takes no connection");
    auto& routing = error_routing();
    const std::lock_guard lock(routing.mutex);
    routing.ours.push_back(display_);
    const auto before = XSetErrorHandler(on_error);
    if (before != on_error) routing.others = before;
}

XClient::~XClient() {
    {
        auto& routing = error_routing();
        const std::lock_guard lock(routing.mutex);
        std::erase(routing.ours, display_);
    }
    XCloseDisplay(display_);
}

std::optional<Image8> XClient::read(int x, int y, int width, int height) const {
    XImage* image = XGetImage(display_,
                              XDefaultRootWindow(display_),
                              x,
                              y,
                              static_cast<unsigned>(width),
                              static_cast<unsigned>(height),
                              AllPlanes,
                              ZPixmap);
    if (!image) return std::nullopt;
    Image8 picture(width, height, 3);
    for (int row = 0; row < height; ++row) {
        // 32 bits a pixel, blue first: what a little-endian server of depth 24 sends.
        const auto from = reinterpret_cast<const unsigned char*>(image->data) +
                          static_cast<std::ptrdiff_t>(row) * image->bytes_per_line;
        for (int column = 0; column < width; ++column) {
            std::uint8_t* pixel = picture.pixel(column, row);
            for (int c = 0; c < 3; ++c) pixel[c] = from[4 * column + 2 - c];
        }
    }
    XDestroyImage(image);
    return picture;
}

}  // namespace livery
