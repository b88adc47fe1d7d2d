// What goes on when another session takes a window's place.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "gl/window.h"
#include "projection/projector_screen.h"
#include "studio/product/new_session.h"
#include "studio/trace.h"
#include "studio/window/imgui_window.h"

namespace livery {

/// Keeps a projector dark while one session's window goes and the next one's comes.
struct DarkProjector {
    Window context;
    ProjectorScreen screen;

    DarkProjector(const std::string& monitor, std::shared_ptr<DesktopWatch> desktop)
        : context({"Livery (dark)", {16, 16}, false, true}), screen(context, std::move(desktop)) {
        screen.set_black(true);
        screen.use_monitor(monitor);
        screen.monitors_changed();
    }
};

/// What one session's window hands to the next one's.
struct Handover {
    std::shared_ptr<OpenedSession> opened;
    std::unique_ptr<DarkProjector> dark;  ///< none: there was no projector
    std::shared_ptr<Trace> trace;         ///< shared as in the studio
    std::shared_ptr<DesktopWatch> desktop;
    bool black = false;                 ///< it was so before
    ImGuiWindow::HandedOut handed_out;  ///< counts go on: who drives the program waits for them
    int frames_drawn = 0;
};

}  // namespace livery
