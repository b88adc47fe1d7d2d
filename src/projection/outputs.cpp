#include "projection/outputs.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>

#include <xcb/randr.h>

#include "projection/desktop_watch.h"

namespace livery {

XConnection::XConnection() {
    int screen_number = 0;
    connection_ = xcb_connect(nullptr, &screen_number);
    if (xcb_connection_has_error(connection_) != 0) {
        xcb_disconnect(connection_);
        const char* display = std::getenv("DISPLAY");
        throw std::runtime_error(
            "no X server answers at DISPLAY=" + std::string(display ? display : "") +
            ". The projector needs a desktop on Xorg, or Xwayland");
    }
    auto screens = xcb_setup_roots_iterator(xcb_get_setup(connection_));
    for (int i = 0; i < screen_number; ++i) xcb_screen_next(&screens);
    screen_ = screens.data;
}

XConnection::~XConnection() { xcb_disconnect(connection_); }

xcb_atom_t XConnection::atom(std::string_view name) const {
    const auto cookie =
        xcb_intern_atom(connection_, false, static_cast<std::uint16_t>(name.size()), name.data());
    const XReply<xcb_intern_atom_reply_t> reply(
        xcb_intern_atom_reply(connection_, cookie, nullptr));
    return reply ? reply->atom : xcb_atom_t{XCB_ATOM_NONE};
}

std::string XConnection::atom_name(xcb_atom_t atom) const {
    const XReply<xcb_get_atom_name_reply_t> reply(
        xcb_get_atom_name_reply(connection_, xcb_get_atom_name(connection_, atom), nullptr));
    if (!reply) return {};
    return {xcb_get_atom_name_name(reply.get()),
            static_cast<std::size_t>(xcb_get_atom_name_name_length(reply.get()))};
}

bool XConnection::has(xcb_extension_t& extension) const {
    const auto* data = xcb_get_extension_data(connection_, &extension);
    return data != nullptr && data->present != 0;
}

void XConnection::synchronise() const {
    const XReply<xcb_get_input_focus_reply_t> reply(
        xcb_get_input_focus_reply(connection_, xcb_get_input_focus(connection_), nullptr));
}

namespace {

double refresh_hz(const xcb_randr_mode_info_t& mode) {
    double lines = mode.vtotal;
    if (mode.mode_flags & XCB_RANDR_MODE_FLAG_DOUBLE_SCAN) lines *= 2.0;
    if (mode.mode_flags & XCB_RANDR_MODE_FLAG_INTERLACE) lines /= 2.0;
    const double pixels = lines * mode.htotal;
    return pixels > 0.0 ? mode.dot_clock / pixels : 0.0;
}

bool is_transformed(const XConnection& x, std::uint32_t crtc) {
    const XReply<xcb_randr_get_crtc_transform_reply_t> reply(xcb_randr_get_crtc_transform_reply(
        x.get(), xcb_randr_get_crtc_transform(x.get(), crtc), nullptr));
    if (!reply) return false;  // older than RandR 1.3: there are none
    constexpr xcb_render_fixed_t kOne = 1 << 16;
    const auto& t = reply->current_transform;
    return t.matrix11 != kOne || t.matrix22 != kOne || t.matrix33 != kOne || t.matrix12 != 0 ||
           t.matrix13 != 0 || t.matrix21 != 0 || t.matrix23 != 0 || t.matrix31 != 0 ||
           t.matrix32 != 0;
}

}  // namespace

std::vector<std::uint8_t> output_property(const XConnection& x,
                                          std::uint32_t output,
                                          std::string_view name) {
    constexpr std::uint32_t kLongestInWords = 256;  // EDID: eight blocks
    const auto cookie = xcb_randr_get_output_property(
        x.get(), output, x.atom(name), XCB_ATOM_NONE, 0, kLongestInWords, false, false);
    const XReply<xcb_randr_get_output_property_reply_t> reply(
        xcb_randr_get_output_property_reply(x.get(), cookie, nullptr));
    if (!reply) return {};
    const auto* data = xcb_randr_get_output_property_data(reply.get());
    return {data, data + xcb_randr_get_output_property_data_length(reply.get())};
}

bool overlap(const Monitor& a, const Monitor& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
           b.y < a.y + a.height;
}

namespace {

/// `lit_unplugged`: whether one shows something, and yet the server last saw no monitor there.
std::vector<Output> known_outputs(const XConnection& x, bool& lit_unplugged) {
    auto* c = x.get();
    lit_unplugged = false;
    const XReply<xcb_randr_get_screen_resources_current_reply_t> resources(
        xcb_randr_get_screen_resources_current_reply(
            c, xcb_randr_get_screen_resources_current(c, x.root()), nullptr));
    if (!resources) return {};
    const XReply<xcb_randr_get_output_primary_reply_t> primary(
        xcb_randr_get_output_primary_reply(c, xcb_randr_get_output_primary(c, x.root()), nullptr));
    std::map<std::uint32_t, xcb_randr_mode_info_t> modes;
    const auto* infos = xcb_randr_get_screen_resources_current_modes(resources.get());
    for (int i = 0; i < resources->num_modes; ++i) modes[infos[i].id] = infos[i];

    std::vector<Output> list;
    const auto* ids = xcb_randr_get_screen_resources_current_outputs(resources.get());
    for (int i = 0; i < resources->num_outputs; ++i) {
        const auto time = resources->config_timestamp;
        const XReply<xcb_randr_get_output_info_reply_t> info(xcb_randr_get_output_info_reply(
            c, xcb_randr_get_output_info(c, ids[i], time), nullptr));
        if (!info || info->crtc == 0) continue;
        const XReply<xcb_randr_get_crtc_info_reply_t> crtc(xcb_randr_get_crtc_info_reply(
            c, xcb_randr_get_crtc_info(c, info->crtc, time), nullptr));
        if (!crtc || crtc->mode == 0) continue;
        if (info->connection == XCB_RANDR_CONNECTION_DISCONNECTED) {
            lit_unplugged = true;
            continue;
        }
        const auto edid = output_property(x, ids[i], "EDID");
        const auto* name =
            reinterpret_cast<const char*>(xcb_randr_get_output_info_name(info.get()));
        const std::string socket(name, name + info->name_len);

        Output output;
        output.output = ids[i];
        output.crtc = info->crtc;
        output.turned =
            (crtc->rotation & (XCB_RANDR_ROTATION_ROTATE_90 | XCB_RANDR_ROTATION_ROTATE_270)) != 0;
        output.transformed = is_transformed(x, info->crtc);
        output.monitor.former_id = former_monitor_id(socket, edid);
        name_output(output, socket, identity_of_edid(edid));
        output.monitor.x = crtc->x;
        output.monitor.y = crtc->y;
        output.monitor.width = crtc->width;
        output.monitor.height = crtc->height;
        output.monitor.primary = primary && primary->output == ids[i];
        if (const auto mode = modes.find(crtc->mode); mode != modes.end()) {
            output.monitor.mode_px = {mode->second.width, mode->second.height};
            output.monitor.refresh_hz = refresh_hz(mode->second);
        }
        if (info->num_preferred > 0 && info->num_modes > 0) {
            const auto best = modes.find(xcb_randr_get_output_info_modes(info.get())[0]);
            if (best != modes.end()) {
                output.preferred_px = {best->second.width, best->second.height};
            }
        }
        list.push_back(std::move(output));
    }
    std::sort(list.begin(), list.end(), [](const Output& a, const Output& b) {
        return std::tie(a.monitor.x, a.monitor.y, a.monitor.id) <
               std::tie(b.monitor.x, b.monitor.y, b.monitor.id);
    });
    int number = 0;
    for (auto& output : list) output.monitor.number = ++number;
    return list;
}

}  // namespace

void name_output(Output& output, const std::string& socket, const DisplayIdentity& identity) {
    output.socket = socket;
    output.monitor.identity = identity;
    output.monitor.id = monitor_id(socket, identity);
    const std::string name = display_name(identity);
    output.monitor.name = name.empty() ? socket : socket + ", " + name;
}

std::vector<Output> read_outputs(const XConnection& x, DesktopWatch* desktop) {
    bool lit_unplugged = false;
    auto list = known_outputs(x, lit_unplugged);
    if (lit_unplugged) {
        // A cable was pulled, or plugged in without a word from the driver: the full question makes
        // the server look.
        const XReply<xcb_randr_get_screen_resources_reply_t> looked(
            xcb_randr_get_screen_resources_reply(
                x.get(), xcb_randr_get_screen_resources(x.get(), x.root()), nullptr));
        list = known_outputs(x, lit_unplugged);
    }
    if (desktop) desktop->name_outputs(list);
    return list;
}

namespace {

constexpr const char* kOverlayProperty = "_LIVERY_OVERLAY";

bool is_visible_in(const XConnection& x, xcb_window_t window, const Monitor& area) {
    auto* c = x.get();
    const XReply<xcb_get_window_attributes_reply_t> attributes(
        xcb_get_window_attributes_reply(c, xcb_get_window_attributes(c, window), nullptr));
    const XReply<xcb_get_geometry_reply_t> geometry(
        xcb_get_geometry_reply(c, xcb_get_geometry(c, window), nullptr));
    if (!attributes || !geometry || attributes->map_state != XCB_MAP_STATE_VIEWABLE ||
        attributes->_class != XCB_WINDOW_CLASS_INPUT_OUTPUT) {
        return false;
    }
    Monitor place;
    place.x = geometry->x;
    place.y = geometry->y;
    place.width = geometry->width + 2 * geometry->border_width;
    place.height = geometry->height + 2 * geometry->border_width;
    return overlap(place, area);
}

}  // namespace

void mark_as_overlay(const XConnection& x, std::uint32_t window) {
    const std::uint32_t yes = 1;
    xcb_change_property(x.get(),
                        XCB_PROP_MODE_REPLACE,
                        window,
                        x.atom(kOverlayProperty),
                        XCB_ATOM_CARDINAL,
                        32,
                        1,
                        &yes);
}

bool is_covered_by_others(const XConnection& x, std::uint32_t window, const Monitor& area) {
    const XReply<xcb_query_tree_reply_t> tree(
        xcb_query_tree_reply(x.get(), xcb_query_tree(x.get(), x.root()), nullptr));
    if (!tree) return false;
    const xcb_atom_t overlay = x.atom(kOverlayProperty);
    const auto is_marked = [&](xcb_window_t other) {
        const auto cookie =
            xcb_get_property(x.get(), false, other, overlay, XCB_ATOM_CARDINAL, 0, 1);
        const XReply<xcb_get_property_reply_t> mark(
            xcb_get_property_reply(x.get(), cookie, nullptr));
        return mark && mark->type != XCB_ATOM_NONE;
    };
    // Lowest first.
    const auto* children = xcb_query_tree_children(tree.get());
    const auto* end = children + xcb_query_tree_children_length(tree.get());
    const auto* own = std::find(children, end, window);
    return own != end && std::any_of(own + 1, end, [&](xcb_window_t other) {
               return is_visible_in(x, other, area) && !is_marked(other);
           });
}

}  // namespace livery
