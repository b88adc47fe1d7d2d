#include "projection/session_bus.h"

#include <cstdlib>
#include <filesystem>

#include <dbus/dbus.h>

namespace livery {
namespace {

constexpr int kTimeout_ms = 200;
constexpr SessionBus::Object kBus = {DBUS_SERVICE_DBUS, DBUS_PATH_DBUS, DBUS_INTERFACE_DBUS};
constexpr SessionBus::Object kScreenSaver = {
    "org.freedesktop.ScreenSaver", "/org/freedesktop/ScreenSaver", "org.freedesktop.ScreenSaver"};

struct Unref {
    void operator()(DBusMessage* message) const { dbus_message_unref(message); }
};
using Message = std::unique_ptr<DBusMessage, Unref>;

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

Message call_to(const SessionBus::Object& object, const char* interface, const char* method) {
    Message message(dbus_message_new_method_call(object.service, object.path, interface, method));
    if (message) dbus_message_set_auto_start(message.get(), false);
    return message;
}

/// Null: an error, a timeout, or nobody there.
Message ask(DBusConnection* connection, const Message& question) {
    if (!question) return nullptr;
    return Message(dbus_connection_send_with_reply_and_block(
        connection, question.get(), kTimeout_ms, nullptr));
}

}  // namespace

std::unique_ptr<SessionBus> SessionBus::connect() {
    const std::string address = bus_address();
    if (address.empty() || !dbus_threads_init_default()) return nullptr;
    DBusConnection* connection = dbus_connection_open_private(address.c_str(), nullptr);
    if (!connection) return nullptr;
    dbus_connection_set_exit_on_disconnect(connection, false);
    std::unique_ptr<SessionBus> bus(new SessionBus(connection));
    // dbus_bus_register() says the same, but waits for half a minute.
    const Message hello = ask(connection, call_to(kBus, kBus.interface, "Hello"));
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

std::optional<bool> SessionBus::read_bool(const Object& object, const char* property) const {
    const Message question = call_to(object, DBUS_INTERFACE_PROPERTIES, "Get");
    if (!question || !dbus_message_append_args(question.get(),
                                               DBUS_TYPE_STRING,
                                               &object.interface,
                                               DBUS_TYPE_STRING,
                                               &property,
                                               DBUS_TYPE_INVALID)) {
        return std::nullopt;
    }
    const Message reply = ask(connection_, question);
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
    const Message question = call_to(kScreenSaver, kScreenSaver.interface, "Inhibit");
    const char* program = "Livery";
    if (!question || !dbus_message_append_args(question.get(),
                                               DBUS_TYPE_STRING,
                                               &program,
                                               DBUS_TYPE_STRING,
                                               &reason,
                                               DBUS_TYPE_INVALID)) {
        return std::nullopt;
    }
    const Message reply = ask(connection_, question);
    dbus_uint32_t inhibition = 0;
    if (!reply || !dbus_message_get_args(
                      reply.get(), nullptr, DBUS_TYPE_UINT32, &inhibition, DBUS_TYPE_INVALID)) {
        return std::nullopt;
    }
    return inhibition;
}

void SessionBus::allow_screensaver(std::uint32_t inhibition) const {
    const Message question = call_to(kScreenSaver, kScreenSaver.interface, "UnInhibit");
    if (question && dbus_message_append_args(
                        question.get(), DBUS_TYPE_UINT32, &inhibition, DBUS_TYPE_INVALID)) {
        ask(connection_, question);
    }
}

}  // namespace livery
