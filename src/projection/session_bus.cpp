#include "projection/session_bus.h"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include <dbus/dbus.h>

namespace livery {

namespace {

constexpr int kTimeout_ms = 200;
constexpr SessionBus::Object kBus = {DBUS_SERVICE_DBUS, DBUS_PATH_DBUS, DBUS_INTERFACE_DBUS};
constexpr SessionBus::Object kScreenSaver = {
    "org.freedesktop.ScreenSaver", "/org/freedesktop/ScreenSaver", "org.freedesktop.ScreenSaver"};

/// Empty: none. libdbus itself would start a bus where there is none.
std::string bus_address() {
    if (const char* address = std::getenv("DBUS_SESSION_BUS_ADDRESS"); address && *address) {
        return address;
    }
    const char* folder = std::getenv("XDG_RUNTIME_DIR");
    if (!folder || !*folder) return {};
    const auto socket = std::filesystem::path(folder) / "bus";
    std::error_code ignored;
    return std::filesystem::exists(socket, ignored) ? "unix:path=" + socket.string()
                                                    : std::string();
}

BusMessage call_to(const SessionBus::Object& object, const char* interface, const char* method) {
    BusMessage message(
        dbus_message_new_method_call(object.service, object.path, interface, method));
    if (message) dbus_message_set_auto_start(message.get(), false);
    return message;
}

/// Null: an error, a timeout, or nobody there.
BusMessage ask(DBusConnection* connection, const BusMessage& question) {
    if (!question) return nullptr;
    return BusMessage(dbus_connection_send_with_reply_and_block(
        connection, question.get(), kTimeout_ms, nullptr));
}

}  // namespace

void ReleaseBusMessage::operator()(DBusMessage* message) const { dbus_message_unref(message); }

std::unique_ptr<SessionBus> SessionBus::connect() {
    const std::string address = bus_address();
    if (address.empty() || !dbus_threads_init_default()) return nullptr;
    DBusConnection* connection = dbus_connection_open_private(address.c_str(), nullptr);
    if (!connection) return nullptr;
    dbus_connection_set_exit_on_disconnect(connection, false);
    std::unique_ptr<SessionBus> bus(new SessionBus(connection));
    // dbus_bus_register() says the same, but waits for half a minute.
    const BusMessage hello = ask(connection, call_to(kBus, kBus.interface, "Hello"));
    const char* name = nullptr;
    if (!hello ||
        !dbus_message_get_args(hello.get(), nullptr, DBUS_TYPE_STRING, &name, DBUS_TYPE_INVALID) ||
        !dbus_bus_set_unique_name(connection, name)) {
        return nullptr;
    }
    return bus;
}

SessionBus::~SessionBus() {
    dbus_connection_close(connection_);
    dbus_connection_unref(connection_);
}

SessionBus::Answer SessionBus::call(const Object& object,
                                    const char* method,
                                    std::chrono::milliseconds patience,
                                    const std::function<bool()>& is_over) {
    constexpr int kSlice_ms = 50;
    const auto end = std::chrono::steady_clock::now() + patience;
    Answer answer;
    answer.error = "no answer";
    const BusMessage question = call_to(object, object.interface, method);
    dbus_uint32_t serial = 0;
    if (!question || !dbus_connection_send(connection_, question.get(), &serial)) return answer;
    while (std::chrono::steady_clock::now() < end && is_connected() && !is_over()) {
        dbus_connection_read_write(connection_, kSlice_ms);
        while (BusMessage message = next_message()) {
            if (dbus_message_get_reply_serial(message.get()) != serial) continue;
            DBusError error = DBUS_ERROR_INIT;
            if (!dbus_set_error_from_message(&error, message.get())) {
                answer.message = std::move(message);
                return answer;
            }
            answer.offered = !dbus_error_has_name(&error, DBUS_ERROR_SERVICE_UNKNOWN) &&
                             !dbus_error_has_name(&error, DBUS_ERROR_NAME_HAS_NO_OWNER);
            answer.error = error.message;
            dbus_error_free(&error);
            return answer;
        }
    }
    return answer;
}

void SessionBus::listen(const std::string& rule) const {
    const BusMessage request = call_to(kBus, kBus.interface, "AddMatch");
    const char* text = rule.c_str();
    if (!request ||
        !dbus_message_append_args(request.get(), DBUS_TYPE_STRING, &text, DBUS_TYPE_INVALID)) {
        return;
    }
    dbus_message_set_no_reply(request.get(), true);
    dbus_connection_send(connection_, request.get(), nullptr);
}

BusMessage SessionBus::next_message() {
    BusMessage message(dbus_connection_pop_message(connection_));
    // The bus itself tells each connection its name.
    heard_ =
        heard_ || (message && dbus_message_get_type(message.get()) == DBUS_MESSAGE_TYPE_SIGNAL &&
                   !dbus_message_is_signal(message.get(), DBUS_INTERFACE_DBUS, "NameAcquired") &&
                   !dbus_message_is_signal(message.get(), DBUS_INTERFACE_LOCAL, "Disconnected"));
    return message;
}

bool SessionBus::heard() {
    dbus_connection_read_write(connection_, 0);
    while (next_message()) {
    }
    return std::exchange(heard_, false);
}

bool SessionBus::is_connected() const { return dbus_connection_get_is_connected(connection_); }

int SessionBus::descriptor() const {
    int descriptor = -1;
    return dbus_connection_get_unix_fd(connection_, &descriptor) ? descriptor : -1;
}

std::optional<bool> SessionBus::read_bool(const Object& object, const char* property) const {
    const BusMessage question = call_to(object, DBUS_INTERFACE_PROPERTIES, "Get");
    if (!question || !dbus_message_append_args(question.get(),
                                               DBUS_TYPE_STRING,
                                               &object.interface,
                                               DBUS_TYPE_STRING,
                                               &property,
                                               DBUS_TYPE_INVALID)) {
        return std::nullopt;
    }
    const BusMessage reply = ask(connection_, question);
    DBusMessageIter outer, value;
    if (!reply || !dbus_message_iter_init(reply.get(), &outer) ||
        dbus_message_iter_get_arg_type(&outer) != DBUS_TYPE_VARIANT) {
        return std::nullopt;
    }
    dbus_message_iter_recurse(&outer, &value);
    if (dbus_message_iter_get_arg_type(&value) != DBUS_TYPE_BOOLEAN) return std::nullopt;
    dbus_bool_t on = false;
    dbus_message_iter_get_basic(&value, &on);
    return on != 0;
}

std::optional<std::uint32_t> SessionBus::inhibit_screensaver(const char* reason) const {
    const BusMessage question = call_to(kScreenSaver, kScreenSaver.interface, "Inhibit");
    const char* program = "Livery";
    if (!question || !dbus_message_append_args(question.get(),
                                               DBUS_TYPE_STRING,
                                               &program,
                                               DBUS_TYPE_STRING,
                                               &reason,
                                               DBUS_TYPE_INVALID)) {
        return std::nullopt;
    }
    const BusMessage reply = ask(connection_, question);
    dbus_uint32_t inhibition = 0;
    if (!reply || !dbus_message_get_args(
                      reply.get(), nullptr, DBUS_TYPE_UINT32, &inhibition, DBUS_TYPE_INVALID)) {
        return std::nullopt;
    }
    return inhibition;
}

void SessionBus::allow_screensaver(std::uint32_t inhibition) const {
    const BusMessage question = call_to(kScreenSaver, kScreenSaver.interface, "UnInhibit");
    if (question && dbus_message_append_args(
                        question.get(), DBUS_TYPE_UINT32, &inhibition, DBUS_TYPE_INVALID)) {
        ask(connection_, question);
    }
}

}  // namespace livery
