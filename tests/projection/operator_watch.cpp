#include "operator_watch.h"

#include <stdexcept>

#include <xcb/randr.h>
#include <xcb/xtest.h>

#include "projection/outputs.h"

namespace livery {
namespace {

Rectangle area_of(const XConnection& x, std::uint32_t crtc) {
    const XReply<xcb_randr_get_crtc_info_reply_t> info(xcb_randr_get_crtc_info_reply(
        x.get(), xcb_randr_get_crtc_info(x.get(), crtc, XCB_CURRENT_TIME), nullptr));
    if (!info || info->mode == 0) return {};
    return {info->x, info->y, info->width, info->height};
}

bool contains(const XConnection& x, const Rectangle& area, const Rgb& colour) {
    const XReply<xcb_get_image_reply_t> image(
        xcb_get_image_reply(x.get(),
                            xcb_get_image(x.get(),
                                          XCB_IMAGE_FORMAT_Z_PIXMAP,
                                          x.root(),
                                          static_cast<std::int16_t>(area.x),
                                          static_cast<std::int16_t>(area.y),
                                          static_cast<std::uint16_t>(area.width),
                                          static_cast<std::uint16_t>(area.height),
                                          ~0u),
                            nullptr));
    if (!image) return false;
    const auto* bytes = xcb_get_image_data(image.get());
    for (int i = 0; i + 3 < xcb_get_image_data_length(image.get()); i += 4) {
        if (Rgb{bytes[i + 2], bytes[i + 1], bytes[i]} == colour) return true;
    }
    return false;
}

}  // namespace

OperatorWatch::OperatorWatch(const std::string& output, const Rgb& forbidden)
    : output_(output), forbidden_(forbidden) {
    xcb_test_grab_control(x_.get(), true);
    for (const auto& found : read_outputs(x_, nullptr)) {
        if (found.socket == output) crtc_ = found.crtc;
    }
    if (crtc_ == 0) throw std::runtime_error("no monitor at " + output);
    thread_ = std::thread([this] {
        while (!over_) look();
    });
}

OperatorWatch::~OperatorWatch() {
    over_ = true;
    thread_.join();
}

void OperatorWatch::look() {
    const Rectangle area = area_of(x_, crtc_);
    if (area.width == 0) return;
    // A cross through the middle: quick, and no window of a monitor's size misses it.
    const Rectangle row{area.x, area.y + area.height / 2, area.width, 1};
    const Rectangle column{area.x + area.width / 2, area.y, 1, area.height};
    const bool found = contains(x_, row, forbidden_) || contains(x_, column, forbidden_);
    if (!(area_of(x_, crtc_) == area)) return;  // it moved in between
    places_ += area == last_ ? 0 : 1;
    last_ = area;
    wrong_ += found ? 1 : 0;
    ++looks_;
}

}  // namespace livery
