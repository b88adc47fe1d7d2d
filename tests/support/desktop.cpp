#include "support/desktop.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <utility>

#include <X11/XKBlib.h>
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/extensions/XTest.h>
#include <X11/extensions/Xrandr.h>
#include <fmt/format.h>

#include "support/x_server.h"

namespace livery {
namespace {

/// How long a person holds a key or a button.
constexpr int held_ms = 40;

std::string mode_name(glm::ivec2 size_px) { return fmt::format("{}x{}", size_px.x, size_px.y); }

/// Where a monitor is, nothing while it is off.
std::optional<Rectangle> area_of_output(Display* display, const std::string& name) {
    const auto resources = XRRGetScreenResourcesCurrent(display, XDefaultRootWindow(display));
    std::optional<Rectangle> area;
    for (int i = 0; i < resources->noutput; ++i) {
        const auto output = XRRGetOutputInfo(display, resources, resources->outputs[i]);
        if (output->crtc != None && output->name == name) {
            const auto crtc = XRRGetCrtcInfo(display, resources, output->crtc);
            if (crtc->mode != None) {
                area = Rectangle{crtc->x,
                                 crtc->y,
                                 static_cast<int>(crtc->width),
                                 static_cast<int>(crtc->height)};
            }
            XRRFreeCrtcInfo(crtc);
        }
        XRRFreeOutputInfo(output);
    }
    XRRFreeScreenResources(resources);
    return area;
}

/// Keycodes of "ctrl+z", in the order in which fingers go down.
std::vector<KeyCode> key_codes(Display* display, const std::string& keys) {
    std::vector<KeyCode> codes;
    std::size_t from = 0;
    while (from <= keys.size()) {
        const auto plus = std::min(keys.find('+', from), keys.size());
        std::string name = keys.substr(from, plus - from);
        if (name == "ctrl") name = "Control_L";
        if (name == "shift") name = "Shift_L";
        if (name == "alt") name = "Alt_L";
        const KeyCode code = XKeysymToKeycode(display, XStringToKeysym(name.c_str()));
        if (code == 0) throw std::invalid_argument("no such key: " + name);
        codes.push_back(code);
        from = plus + 1;
    }
    return codes;
}

bool knows_mode(Display* display, const std::string& name) {
    const auto resources = XRRGetScreenResourcesCurrent(display, XDefaultRootWindow(display));
    bool known = false;
    for (int i = 0; i < resources->nmode; ++i) known |= resources->modes[i].name == name;
    XRRFreeScreenResources(resources);
    return known;
}

std::string title_of(Display* display, Window window) {
    char* name = nullptr;
    if (!XFetchName(display, window, &name) || !name) return {};
    const std::string title = name;
    XFree(name);
    return title;
}

std::vector<Window> children_of(Display* display, Window window) {
    Window root = None, parent = None;
    Window* children = nullptr;
    unsigned count = 0;
    if (!XQueryTree(display, window, &root, &parent, &children, &count)) return {};
    const std::vector<Window> list(children, children + count);
    if (children) XFree(children);
    return list;
}

}  // namespace

struct Desktop::State {
    explicit State(glm::ivec2 largest_px) : server(largest_px) {}

    XServer server;
    XClient client{server.display()};
    Display* connection = client.display();
    std::unique_ptr<ChildProcess> window_manager;
    std::optional<std::string> display_before;
    DesktopOptions options;
    glm::ivec2 screen_px{0};

    Window root() const { return XDefaultRootWindow(connection); }
};

std::ostream& operator<<(std::ostream& stream, const Rgb& colour) {
    return stream << '(' << colour.r << ' ' << colour.g << ' ' << colour.b << ')';
}

int distance(const Rgb& a, const Rgb& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

Rgb colour_at(const Image8& picture, int x, int y) {
    const auto pixel = picture.pixel(x, y);
    return {pixel[0], pixel[1], pixel[2]};
}

Rgb mean_colour(const Image8& picture, const Rectangle& area) {
    Rgb sum;
    for (int y = area.y; y < area.y + area.height; ++y) {
        for (int x = area.x; x < area.x + area.width; ++x) {
            const Rgb colour = colour_at(picture, x, y);
            sum = {sum.r + colour.r, sum.g + colour.g, sum.b + colour.b};
        }
    }
    const int count = area.width * area.height;
    return {sum.r / count, sum.g / count, sum.b / count};
}

double fraction_different(const Image8& a, const Image8& b, int tolerance) {
    if (a.width != b.width || a.height != b.height) return 1.0;
    std::size_t different = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            different += distance(colour_at(a, x, y), colour_at(b, x, y)) > tolerance;
        }
    }
    return static_cast<double>(different) / static_cast<double>(a.pixel_count());
}

Desktop::Desktop(const DesktopOptions& options)
    : state_(std::make_unique<State>(options.operator_px + options.projector_px)) {
    state_->options = options;
    state_->screen_px = options.operator_px + options.projector_px;
    if (const char* before = std::getenv("DISPLAY")) state_->display_before = before;
    ::setenv("DISPLAY", display().c_str(), 1);
    ::unsetenv("WAYLAND_DISPLAY");
    for (const auto& [output, size] : {std::pair(operator_output, options.operator_px),
                                       std::pair(projector_output, options.projector_px)}) {
        const std::string mode = mode_name(size);
        if (!knows_mode(state_->connection, mode)) {
            // Any timing does, nothing is sent anywhere: 60 Hz with short pauses.
            const auto n = [](int value) { return std::to_string(value); };
            const glm::ivec2 total = size + glm::ivec2(24, 9);
            xrandr({"--newmode",
                    mode,
                    fmt::format("{:.3f}", total.x * total.y * 60e-6),
                    n(size.x),
                    n(size.x + 8),
                    n(size.x + 16),
                    n(total.x),
                    n(size.y),
                    n(size.y + 3),
                    n(size.y + 6),
                    n(total.y)});
        }
        xrandr({"--addmode", output, mode});
    }
    xrandr({"--output",
            operator_output,
            "--mode",
            mode_name(options.operator_px),
            "--pos",
            "0x0",
            "--primary"});
    plug_projector();
    if (options.window_manager) {
        state_->window_manager = std::make_unique<ChildProcess>(
            ChildOptions{{"openbox", "--sm-disable"}, {}, "/dev/null", {}});
        const Atom check = XInternAtom(state_->connection, "_NET_SUPPORTING_WM_CHECK", False);
        const auto running = [&] {
            Atom type = None;
            int format = 0;
            unsigned long count = 0, left = 0;
            unsigned char* value = nullptr;
            XGetWindowProperty(state_->connection,
                               state_->root(),
                               check,
                               0,
                               1,
                               False,
                               AnyPropertyType,
                               &type,
                               &format,
                               &count,
                               &left,
                               &value);
            if (value) XFree(value);
            return count == 1;
        };
        if (!wait_until(running)) throw std::runtime_error("openbox did not start");
    }
}

Desktop::~Desktop() {
    state_->window_manager.reset();
    if (state_->display_before) {
        ::setenv("DISPLAY", state_->display_before->c_str(), 1);
    } else {
        ::unsetenv("DISPLAY");
    }
}

const std::string& Desktop::display() const { return state_->server.display(); }

pid_t Desktop::server() const { return state_->server.process(); }

void Desktop::xrandr(const std::vector<std::string>& arguments) {
    const TemporaryFolder folder;
    ChildOptions options;
    options.arguments = {"xrandr"};
    options.arguments.insert(options.arguments.end(), arguments.begin(), arguments.end());
    options.output = folder / "output";
    if (ChildProcess(options).wait(std::chrono::seconds(20)) != 0) {
        throw std::runtime_error("xrandr failed: " + tail_of(options.output));
    }
}

// The screen behind the monitors keeps its size: while it changes, this server shows old pixels
// in rows of the new length, which no program can help.
void Desktop::unplug_projector() {
    xrandr({"--fb", mode_name(state_->screen_px), "--output", projector_output, "--off"});
}

void Desktop::plug_projector(Side side) {
    const char* where = side == Side::right   ? "--right-of"
                        : side == Side::left  ? "--left-of"
                        : side == Side::above ? "--above"
                                              : "--below";
    xrandr({"--fb",
            mode_name(state_->screen_px),
            "--output",
            projector_output,
            "--mode",
            mode_name(state_->options.projector_px),
            where,
            operator_output});
}

bool Desktop::projector_plugged() const {
    return area_of_output(state_->connection, projector_output).has_value();
}

Rectangle Desktop::operator_area() const {
    return area_of_output(state_->connection, operator_output).value();
}

Rectangle Desktop::projector_area() const {
    const auto area = area_of_output(state_->connection, projector_output);
    if (!area) throw std::logic_error("the projector is unplugged");
    return *area;
}

Image8 Desktop::read(const Rectangle& area) const {
    auto picture = state_->client.read(area.x, area.y, area.width, area.height);
    if (!picture) {
        throw std::invalid_argument(fmt::format(
            "not on the screen: {}x{} at {},{}", area.width, area.height, area.x, area.y));
    }
    return std::move(*picture);
}

Rgb Desktop::pixel(int x, int y) const { return colour_at(read({x, y, 1, 1}), 0, 0); }

void Desktop::move_pointer(int x, int y) {
    XTestFakeMotionEvent(state_->connection, -1, x, y, CurrentTime);
    XSync(state_->connection, False);
}

void Desktop::press_button(int button) {
    XTestFakeButtonEvent(state_->connection, static_cast<unsigned>(button), True, CurrentTime);
    XSync(state_->connection, False);
}

void Desktop::release_button(int button) {
    XTestFakeButtonEvent(state_->connection, static_cast<unsigned>(button), False, CurrentTime);
    XSync(state_->connection, False);
}

void Desktop::click(int x, int y, int button) {
    move_pointer(x, y);
    // The pointer rests on what it will click, as a person's does.
    sleep_ms(held_ms);
    press_button(button);
    sleep_ms(held_ms);
    release_button(button);
}

void Desktop::double_click(int x, int y) {
    click(x, y);
    click(x, y);
}

void Desktop::drag(glm::ivec2 from, glm::ivec2 to) {
    constexpr int steps = 10;
    move_pointer(from.x, from.y);
    sleep_ms(held_ms);
    press_button();
    for (int i = 1; i <= steps; ++i) {
        sleep_ms(held_ms / 2);
        const glm::ivec2 at = from + (to - from) * i / steps;
        move_pointer(at.x, at.y);
    }
    sleep_ms(held_ms);
    release_button();
}

void Desktop::scroll(int notches) {
    for (int i = 0; i < std::abs(notches); ++i) {
        press_button(notches > 0 ? 4 : 5);
        release_button(notches > 0 ? 4 : 5);
        sleep_ms(held_ms);
    }
}

void Desktop::hold_key(const std::string& keys) {
    for (const KeyCode code : key_codes(state_->connection, keys)) {
        XTestFakeKeyEvent(state_->connection, code, True, CurrentTime);
    }
    XSync(state_->connection, False);
}

void Desktop::release_key(const std::string& keys) {
    auto codes = key_codes(state_->connection, keys);
    std::reverse(codes.begin(), codes.end());
    for (const KeyCode code : codes) {
        XTestFakeKeyEvent(state_->connection, code, False, CurrentTime);
    }
    XSync(state_->connection, False);
}

void Desktop::press_key(const std::string& keys) {
    hold_key(keys);
    sleep_ms(held_ms);
    release_key(keys);
}

void Desktop::type(const std::string& text) {
    for (const char letter : text) {
        // Keysyms of Latin letters are their character codes.
        const auto symbol = static_cast<KeySym>(static_cast<unsigned char>(letter));
        const KeyCode code = XKeysymToKeycode(state_->connection, symbol);
        const bool shifted = XkbKeycodeToKeysym(state_->connection, code, 0, 0) != symbol;
        const std::string name = XKeysymToString(symbol);
        press_key(shifted ? "shift+" + name : name);
        sleep_ms(held_ms / 2);
    }
}

std::vector<Desktop::TopWindow> Desktop::windows() const {
    Display* const display = state_->connection;
    std::vector<TopWindow> shown;
    for (const Window window : children_of(display, state_->root())) {
        XWindowAttributes at{};
        if (!XGetWindowAttributes(display, window, &at) || at.map_state != IsViewable ||
            at.c_class != InputOutput) {
            continue;
        }
        TopWindow found{title_of(display, window), {at.x, at.y, at.width, at.height}};
        // A window manager puts its frame around the program's window.
        for (const Window child : children_of(display, window)) {
            if (found.title.empty()) found.title = title_of(display, child);
        }
        shown.push_back(found);
    }
    return shown;
}

void Desktop::minimise_active_window() {
    Display* const connection = state_->connection;
    const Atom active = XInternAtom(connection, "_NET_ACTIVE_WINDOW", False);
    Atom type = None;
    int format = 0;
    unsigned long count = 0, left = 0;
    unsigned char* value = nullptr;
    XGetWindowProperty(connection,
                       state_->root(),
                       active,
                       0,
                       1,
                       False,
                       XA_WINDOW,
                       &type,
                       &format,
                       &count,
                       &left,
                       &value);
    const Window window = count == 1 ? *reinterpret_cast<Window*>(value) : None;
    if (value) XFree(value);
    if (window == None) throw std::logic_error("no window is active");
    XIconifyWindow(connection, window, XDefaultScreen(connection));
    XSync(connection, False);
}

}  // namespace livery
