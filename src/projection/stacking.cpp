#include "projection/stacking.h"

#include <algorithm>

#include "projection/outputs.h"

namespace livery {
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
