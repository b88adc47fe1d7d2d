#include "support/wayland_desktop.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <dbus/dbus.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace livery {
namespace {

namespace fs = std::filesystem;

constexpr const char* kService = "org.gnome.Mutter.DisplayConfig";
constexpr const char* kPath = "/org/gnome/Mutter/DisplayConfig";

bool is_installed(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        if (fs::exists(fs::path(folder) / program)) return true;
    }
    return false;
}

std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// Appends a value of a basic type.
template <typename T>
void put(DBusMessageIter& at, int type, T value) {
    dbus_message_iter_append_basic(&at, type, &value);
}

/// Appends an array or a structure that `fill` writes.
template <typename Fill>
void put_container(DBusMessageIter& at, int type, const char* signature, const Fill& fill) {
    DBusMessageIter content;
    dbus_message_iter_open_container(&at, type, signature, &content);
    fill(content);
    dbus_message_iter_close_container(&at, &content);
}

void put_empty_dictionary(DBusMessageIter& at) {
    put_container(at, DBUS_TYPE_ARRAY, "{sv}", [](DBusMessageIter&) {});
}

struct Placed {
    int x = 0;
    double scale = 1.0;
    int transform = 0;
    bool primary = false;
    const char* connector = "";
    glm::ivec2 mode_px{0};
};

void put_placed(DBusMessageIter& list, const Placed& placed) {
    put_container(list, DBUS_TYPE_STRUCT, nullptr, [&](DBusMessageIter& logical) {
        put(logical, DBUS_TYPE_INT32, dbus_int32_t{placed.x});
        put(logical, DBUS_TYPE_INT32, dbus_int32_t{0});
        put(logical, DBUS_TYPE_DOUBLE, placed.scale);
        put(logical, DBUS_TYPE_UINT32, static_cast<dbus_uint32_t>(placed.transform));
        put(logical, DBUS_TYPE_BOOLEAN, dbus_bool_t{placed.primary});
        put_container(logical, DBUS_TYPE_ARRAY, "(ssa{sv})", [&](DBusMessageIter& monitors) {
            put_container(monitors, DBUS_TYPE_STRUCT, nullptr, [&](DBusMessageIter& monitor) {
                const auto mode = fmt::format("{}x{}@60.000", placed.mode_px.x, placed.mode_px.y);
                put(monitor, DBUS_TYPE_STRING, placed.connector);
                put(monitor, DBUS_TYPE_STRING, mode.c_str());
                put_empty_dictionary(monitor);
            });
        });
    });
}

/// The answer; throws what the bus says instead.
DBusMessage* asked(DBusConnection* connection, DBusMessage* question) {
    constexpr int kTimeout_ms = 20000;
    DBusError error = DBUS_ERROR_INIT;
    DBusMessage* answer =
        dbus_connection_send_with_reply_and_block(connection, question, kTimeout_ms, &error);
    dbus_message_unref(question);
    if (answer) return answer;
    const std::string words = error.message;
    dbus_error_free(&error);
    throw std::runtime_error("Mutter: " + words);
}

}  // namespace

std::string WaylandDesktop::what_is_missing() {
    std::string missing;
    for (const char* program : {"mutter", "Xwayland", "dbus-daemon"}) {
        if (is_installed(program)) continue;
        missing += std::string(missing.empty() ? "" : ", ") + program;
    }
    return missing.empty()
               ? ""
               : "not installed: " + missing + " (packages mutter, xwayland, dbus-daemon)";
}

WaylandDesktop::WaylandDesktop(glm::ivec2 operator_px, glm::ivec2 projector_px)
    : operator_px_(operator_px), projector_px_(projector_px) {
    fs::create_directory(folder_ / "run");
    fs::permissions(folder_ / "run", fs::perms::owner_all);
    // Without this setting Mutter has no scales but whole ones.
    fs::create_directories(folder_ / "home/.config/glib-2.0/settings");
    folder_.write("home/.config/glib-2.0/settings/keyfile",
                  "[org/gnome/mutter]\nexperimental-features=['scale-monitor-framebuffer']\n");
    // The folder's name has spaces, which an address must escape: a name of its own is simpler.
    const std::string address = "unix:abstract=livery-wayland-" + std::to_string(::getpid());
    const auto configuration =
        folder_.write("bus.conf",
                      "<busconfig><type>session</type><listen>" + address +
                          "</listen><policy context=\"default\"><allow send_destination=\"*\"/>"
                          "<allow eavesdrop=\"true\"/><allow own=\"*\"/></policy></busconfig>");
    bus_ = std::make_unique<ChildProcess>(
        ChildOptions{{"dbus-daemon", "--nofork", "--config-file=" + configuration.string()},
                     {},
                     folder_ / "bus-output",
                     {}});
    dbus_threads_init_default();
    wait_until([&] {
        connection_ = dbus_connection_open_private(address.c_str(), nullptr);
        return connection_ != nullptr || !bus_->running();
    });
    if (!connection_ || !dbus_bus_register(connection_, nullptr)) {
        throw std::runtime_error("dbus-daemon does not come up: " +
                                 tail_of(folder_ / "bus-output"));
    }
    dbus_connection_set_exit_on_disconnect(connection_, false);

    ChildOptions options;
    const auto monitor = [](glm::ivec2 px) { return fmt::format("{}x{}", px.x, px.y); };
    options.arguments = {"mutter",
                         "--headless",
                         "--wayland",
                         "--virtual-monitor",
                         monitor(operator_px),
                         "--virtual-monitor",
                         monitor(projector_px)};
    options.environment = {{"DBUS_SESSION_BUS_ADDRESS", address},
                           {"XDG_RUNTIME_DIR", (folder_ / "run").string()},
                           {"HOME", (folder_ / "home").string()},
                           {"XDG_CONFIG_HOME", (folder_ / "home/.config").string()},
                           {"GSETTINGS_BACKEND", "keyfile"},
                           {"DISPLAY", ""}};
    options.output = folder_ / "mutter-output";
    // Mutter makes the folder of X's sockets with this mask, and then finds it closed.
    const mode_t mask = ::umask(0);
    mutter_ = std::make_unique<ChildProcess>(options);
    ::umask(mask);
    const auto up = [&] {
        const std::string said = text_of(options.output);
        const std::string before = "public X11 display ";
        const auto at = said.find(before), end = said.find(',', at);
        if (at == std::string::npos || end == std::string::npos) return false;
        display_ = said.substr(at + before.size(), end - at - before.size());
        for (const auto& file : fs::directory_iterator(folder_ / "run")) {
            const std::string name = file.path().filename().string();
            if (name.starts_with(".mutter-Xwaylandauth")) authority_ = file.path().string();
        }
        return !authority_.empty() && dbus_bus_name_has_owner(connection_, kService, nullptr);
    };
    wait_until([&] { return up() || !mutter_->running(); });
    if (display_.empty() || authority_.empty() || !mutter_->running()) {
        throw std::runtime_error("mutter does not come up: " + tail_of(options.output));
    }
    set_projector(1.0);
}

WaylandDesktop::~WaylandDesktop() {
    // Killed, it would leave X's locks and sockets behind.
    if (mutter_) {
        mutter_->send(SIGTERM);
        mutter_->wait(std::chrono::seconds(20));
    }
    if (!connection_) return;
    dbus_connection_close(connection_);
    dbus_connection_unref(connection_);
}

std::map<std::string, std::string> WaylandDesktop::environment() const {
    const char* address = "DBUS_SESSION_BUS_ADDRESS";
    return {{address, "unix:abstract=livery-wayland-" + std::to_string(::getpid())},
            {"XDG_RUNTIME_DIR", (folder_ / "run").string()},
            {"DISPLAY", display_},
            {"XAUTHORITY", authority_}};
}

void WaylandDesktop::set_projector(double scale, int transform) {
    DBusMessage* state = asked(
        connection_, dbus_message_new_method_call(kService, kPath, kService, "GetCurrentState"));
    dbus_uint32_t serial = 0;
    DBusMessageIter at;
    dbus_message_iter_init(state, &at);
    dbus_message_iter_get_basic(&at, &serial);
    dbus_message_unref(state);

    constexpr dbus_uint32_t kTemporary = 1;
    DBusMessage* request =
        dbus_message_new_method_call(kService, kPath, kService, "ApplyMonitorsConfig");
    dbus_message_iter_init_append(request, &at);
    put(at, DBUS_TYPE_UINT32, serial);
    put(at, DBUS_TYPE_UINT32, kTemporary);
    put_container(at, DBUS_TYPE_ARRAY, "(iiduba(ssa{sv}))", [&](DBusMessageIter& list) {
        put_placed(list, {0, 1.0, 0, true, operator_connector, operator_px_});
        put_placed(list,
                   {operator_px_.x, scale, transform, false, projector_connector, projector_px_});
    });
    put_empty_dictionary(at);
    dbus_message_unref(asked(connection_, request));
}

}  // namespace livery
