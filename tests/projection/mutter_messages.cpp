#include "mutter_messages.h"

#include <dbus/dbus.h>
#include <fmt/format.h>

namespace livery {
namespace {

/// An array, structure, dictionary entry or variant that is being written.
class Container {
  public:
    Container(DBusMessageIter& parent, int type, const char* signature = nullptr)
        : parent_(parent) {
        dbus_message_iter_open_container(&parent_, type, signature, &content);
    }
    ~Container() { dbus_message_iter_close_container(&parent_, &content); }
    Container(const Container&) = delete;
    Container& operator=(const Container&) = delete;

    DBusMessageIter content{};

  private:
    DBusMessageIter& parent_;
};

void put(DBusMessageIter& at, int type, const void* value) {
    dbus_message_iter_append_basic(&at, type, value);
}
void put(DBusMessageIter& at, const std::string& text) {
    const char* value = text.c_str();
    put(at, DBUS_TYPE_STRING, &value);
}
void put(DBusMessageIter& at, std::int32_t value) { put(at, DBUS_TYPE_INT32, &value); }
void put(DBusMessageIter& at, std::uint32_t value) { put(at, DBUS_TYPE_UINT32, &value); }
void put(DBusMessageIter& at, double value) { put(at, DBUS_TYPE_DOUBLE, &value); }
void put(DBusMessageIter& at, bool value) {
    const dbus_bool_t on = value;
    put(at, DBUS_TYPE_BOOLEAN, &on);
}

template <typename T>
void put_property(DBusMessageIter& dictionary, const char* name, const char* type, T value) {
    Container entry(dictionary, DBUS_TYPE_DICT_ENTRY);
    put(entry.content, std::string(name));
    Container variant(entry.content, DBUS_TYPE_VARIANT, type);
    put(variant.content, value);
}

void put_names(DBusMessageIter& at, const SaidMonitor& monitor) {
    Container names(at, DBUS_TYPE_STRUCT);
    for (const auto* text :
         {&monitor.connector, &monitor.maker, &monitor.product, &monitor.serial}) {
        put(names.content, *text);
    }
}

void put_mode(DBusMessageIter& modes, const SaidMode& said) {
    Container mode(modes, DBUS_TYPE_STRUCT);
    put(mode.content, fmt::format("{}x{}@60.000", said.width, said.height));
    put(mode.content, std::int32_t{said.width});
    put(mode.content, std::int32_t{said.height});
    put(mode.content, 60.0);
    put(mode.content, 1.0);
    {
        Container scales(mode.content, DBUS_TYPE_ARRAY, "d");
        for (const double scale : {1.0, 1.5, 2.0}) put(scales.content, scale);
    }
    Container properties(mode.content, DBUS_TYPE_ARRAY, "{sv}");
    if (said.current) put_property(properties.content, "is-current", "b", true);
    if (said.preferred) put_property(properties.content, "is-preferred", "b", true);
}

void put_monitor(DBusMessageIter& monitors, const SaidMonitor& said) {
    Container monitor(monitors, DBUS_TYPE_STRUCT);
    put_names(monitor.content, said);
    {
        Container modes(monitor.content, DBUS_TYPE_ARRAY, "(siiddada{sv})");
        for (const SaidMode& mode : said.modes) put_mode(modes.content, mode);
    }
    Container properties(monitor.content, DBUS_TYPE_ARRAY, "{sv}");
    put_property(properties.content, "is-builtin", "b", false);
    put_property(properties.content, "display-name", "s", said.product);
    if (said.colour_mode) put_property(properties.content, "color-mode", "u", *said.colour_mode);
}

void put_logical(DBusMessageIter& list, const SaidLogicalMonitor& said, const SaidState& state) {
    Container logical(list, DBUS_TYPE_STRUCT);
    put(logical.content, std::int32_t{said.x});
    put(logical.content, std::int32_t{said.y});
    put(logical.content, said.scale);
    put(logical.content, said.transform);
    put(logical.content, said.x == 0);
    {
        Container monitors(logical.content, DBUS_TYPE_ARRAY, "(ssss)");
        for (const std::string& connector : said.connectors) {
            SaidMonitor named;
            named.connector = connector;
            for (const SaidMonitor& monitor : state.monitors) {
                if (monitor.connector == connector) named = monitor;
            }
            put_names(monitors.content, named);
        }
    }
    const Container properties(logical.content, DBUS_TYPE_ARRAY, "{sv}");
}

}  // namespace

SaidState said_of_two(double projector_scale, std::uint32_t projector_transform) {
    return {
        {{"eDP-1", "BOE", "0x0747", "0x00000000", {{1280, 800}}},
         {"HDMI-1", "EPS", "EPSON PJ", "X4KF123", {{1920, 1080}, {1280, 720, false, false}}}},
        {{0, 0, 1.0, 0, {"eDP-1"}}, {1280, 0, projector_scale, projector_transform, {"HDMI-1"}}}};
}

BusMessage mutter_message(const SaidState& state) {
    BusMessage message(dbus_message_new(DBUS_MESSAGE_TYPE_METHOD_RETURN));
    DBusMessageIter at;
    dbus_message_iter_init_append(message.get(), &at);
    put(at, std::uint32_t{2});
    {
        Container monitors(at, DBUS_TYPE_ARRAY, "((ssss)a(siiddada{sv})a{sv})");
        for (const SaidMonitor& monitor : state.monitors) put_monitor(monitors.content, monitor);
    }
    {
        Container logical(at, DBUS_TYPE_ARRAY, "(iiduba(ssss)a{sv})");
        for (const SaidLogicalMonitor& said : state.logical_monitors) {
            put_logical(logical.content, said, state);
        }
    }
    {
        Container properties(at, DBUS_TYPE_ARRAY, "{sv}");
        put_property(properties.content, "supports-changing-layout-mode", "b", true);
        if (state.layout_mode) {
            put_property(properties.content, "layout-mode", "u", *state.layout_mode);
        }
    }
    return message;
}

MutterState mutter_state(const SaidState& state) {
    return read_mutter_state(*mutter_message(state));
}

}  // namespace livery
