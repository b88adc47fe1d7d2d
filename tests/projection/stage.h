// A desktop with a projector's window and pictures to show in it.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "gl/handles.h"
#include "gl/program.h"
#include "gl/window.h"
#include "projection/projector_screen.h"
#include "support/desktop.h"

namespace livery {

/// A monitor of 1280x800 and the projector on the right. Starting a server costs more than most
/// tests, so it serves the next one, too.
inline Desktop& shared_desktop(bool window_manager, glm::ivec2 projector_px) {
    static std::map<std::tuple<bool, int, int>, std::unique_ptr<Desktop>> desktops;
    auto& desktop = desktops[{window_manager, projector_px.x, projector_px.y}];
    if (!desktop) {
        desktop =
            std::make_unique<Desktop>(DesktopOptions{{1280, 800}, projector_px, window_manager});
    }
    ::setenv("DISPLAY", desktop->display().c_str(), 1);
    desktop->plug_projector();
    desktop->move_pointer(640, 400);
    return *desktop;
}

/// Declared in the order in which a program makes them.
struct Stage {
    Desktop& desktop;
    WindowSystem window_system;
    Window share;

    explicit Stage(bool window_manager = false, glm::ivec2 projector_px = {1280, 800})
        : desktop(shared_desktop(window_manager, projector_px)), share(invisible()) {
        share.make_current();
        set_gl_checks(true);
    }
    ~Stage() { set_gl_checks(false); }

    static WindowOptions invisible() {
        WindowOptions options;
        options.visible = false;
        return options;
    }

    /// The pixels' texture, with a fence behind it. Three channels.
    std::shared_ptr<const ProjectorPicture> picture(std::uint64_t number,
                                                    const Image8& pixels) const {
        std::vector<std::uint8_t> rgba;
        for (std::size_t i = 0; i < pixels.pixel_count(); ++i) {
            const auto* rgb = pixels.values.data() + 3 * i;
            rgba.insert(rgba.end(), {rgb[0], rgb[1], rgb[2], 255});
        }
        auto texture = std::make_shared<Texture2D>(pixels.width, pixels.height, TexelFormat::rgba8);
        texture->upload(std::span<const std::uint8_t>(rgba));
        auto made = std::make_shared<ProjectorPicture>();
        made->number = number;
        made->texture = texture->name();
        made->size_px = {pixels.width, pixels.height};
        made->ready = std::make_shared<Fence>(Fence::after_everything_so_far());
        made->owner = texture;
        return made;
    }

    std::shared_ptr<const ProjectorPicture> plain(std::uint64_t number,
                                                  const Rgb& colour,
                                                  glm::ivec2 size_px = {1280, 800}) const {
        Image8 pixels(size_px.x, size_px.y, 3);
        for (std::size_t i = 0; i < pixels.values.size(); i += 3) {
            pixels.values[i] = static_cast<std::uint8_t>(colour.r);
            pixels.values[i + 1] = static_cast<std::uint8_t>(colour.g);
            pixels.values[i + 2] = static_cast<std::uint8_t>(colour.b);
        }
        return picture(number, pixels);
    }

    /// The middle of the projector's monitor.
    Rgb on_projector() const {
        const Rectangle area = desktop.projector_area();
        return desktop.pixel(area.x + area.width / 2, area.y + area.height / 2);
    }
    bool projector_becomes(const Rgb& colour) const {
        return wait_until([&] { return on_projector() == colour; });
    }
};

constexpr Rgb kBlack{0, 0, 0}, kMagenta{254, 3, 253}, kGreen{2, 180, 40}, kBlue{10, 20, 230};

}  // namespace livery
