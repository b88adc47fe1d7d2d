#include "fake_desktop_bus.h"

#include <cstdlib>
#include <stdexcept>

#include <dbus/dbus.h>

namespace livery {

FakeDesktopBus::FakeDesktopBus(const std::string& service, const std::string& another) {
    // The folder's name has spaces, which an address must escape: a name of its own is simpler.
    const std::string address = "unix:abstract=livery-test-" + std::to_string(::getpid());
    const auto configuration =
        folder_.write("bus.conf",
                      "<busconfig><type>session</type><listen>" + address +
                          "</listen><policy context=\"default\">"
                          "<allow send_destination=\"*\" eavesdrop=\"true\"/>"
                          "<allow eavesdrop=\"true\"/><allow own=\"*\"/>"
                          "</policy></busconfig>");
    daemon_ = std::make_unique<ChildProcess>(ChildOptions{
        {"dbus-daemon", "--nofork", "--config-file=" + configuration.string()}, {}, {}, {}});
    ::setenv("DBUS_SESSION_BUS_ADDRESS", address.c_str(), 1);
    dbus_threads_init_default();
    const bool up = wait_until([&] {
        connection_ = dbus_connection_open_private(address.c_str(), nullptr);
        return connection_ != nullptr || !daemon_->running();
    });
    if (!up || !connection_ || !dbus_bus_register(connection_, nullptr)) {
        throw std::runtime_error("dbus-daemon does not come up (package dbus-daemon)");
    }
    dbus_connection_set_exit_on_disconnect(connection_, false);
    dbus_bus_request_name(connection_, service.c_str(), 0, nullptr);
    if (!another.empty()) dbus_bus_request_name(connection_, another.c_str(), 0, nullptr);
    thread_ = std::thread([this] { serve(); });
}

FakeDesktopBus::~FakeDesktopBus() {
    over_ = true;
    thread_.join();
    dbus_connection_close(connection_);
    dbus_connection_unref(connection_);
    ::unsetenv("DBUS_SESSION_BUS_ADDRESS");
}

void FakeDesktopBus::serve() {
    while (!over_) {
        dbus_connection_read_write(connection_, 10);
        while (answer_next()) {
        }
    }
}

void FakeDesktopBus::tell_monitors(const std::optional<SaidState>& state) {
    {
        const std::lock_guard lock(mutex_);
        monitors_ = state;
    }
    send_signal(
        "/org/gnome/Mutter/DisplayConfig", "org.gnome.Mutter.DisplayConfig", "MonitorsChanged");
}

void FakeDesktopBus::send_signal(const char* path, const char* interface, const char* member) {
    DBusMessage* signal = dbus_message_new_signal(path, interface, member);
    dbus_connection_send(connection_, signal, nullptr);
    dbus_connection_flush(connection_);
    dbus_message_unref(signal);
}

DBusMessage* FakeDesktopBus::monitors_answer(DBusMessage* question) {
    const std::lock_guard lock(mutex_);
    if (!monitors_) {
        return dbus_message_new_error(question, DBUS_ERROR_FAILED, "no monitors today");
    }
    DBusMessage* answer = mutter_message(*monitors_).release();
    dbus_message_set_destination(answer, dbus_message_get_sender(question));
    dbus_message_set_reply_serial(answer, dbus_message_get_serial(question));
    return answer;
}

bool FakeDesktopBus::answer_next() {
    DBusMessage* question = dbus_connection_pop_message(connection_);
    if (!question) return false;
    if (dbus_message_get_type(question) == DBUS_MESSAGE_TYPE_METHOD_CALL && answers) {
        DBusMessage* answer = dbus_message_new_method_return(question);
        const std::string method = dbus_message_get_member(question);
        if (method == "Get") {
            DBusMessageIter outer, value;
            const dbus_bool_t on = property;
            dbus_message_iter_init_append(answer, &outer);
            dbus_message_iter_open_container(&outer, DBUS_TYPE_VARIANT, "b", &value);
            dbus_message_iter_append_basic(&value, DBUS_TYPE_BOOLEAN, &on);
            dbus_message_iter_close_container(&outer, &value);
        } else if (method == "GetCurrentState") {
            dbus_message_unref(answer);
            answer = monitors_answer(question);
        } else if (method == "Inhibit") {
            const dbus_uint32_t cookie = 77;
            dbus_message_append_args(answer, DBUS_TYPE_UINT32, &cookie, DBUS_TYPE_INVALID);
            ++inhibitions;
        } else if (method == "UnInhibit") {
            dbus_uint32_t cookie = 0;
            dbus_message_get_args(question, nullptr, DBUS_TYPE_UINT32, &cookie, DBUS_TYPE_INVALID);
            if (cookie == 77) --inhibitions;
        }
        dbus_connection_send(connection_, answer, nullptr);
        dbus_connection_flush(connection_);
        dbus_message_unref(answer);
    }
    dbus_message_unref(question);
    return true;
}

}  // namespace livery
