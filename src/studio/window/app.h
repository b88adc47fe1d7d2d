// The desktop program: two windows, a designer swapping paints live.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "mesh/length_unit.h"

namespace livery {

enum class ShadingDevice;

struct DesktopOptions {
    std::filesystem::path session;        ///< empty: the one in the user's folder
    std::string product;                  ///< empty: the session's; for a new session "car"
    std::optional<LengthUnit> unit;       ///< of the (new) product's numbers, for a new session
    std::filesystem::path new_product;    ///< begins a new session with it; empty: none
    std::filesystem::path new_session;    ///< where that is saved; empty: a place is suggested
    std::optional<double> ui_scale;       ///< instead of the screen's and the user's own
    std::optional<glm::ivec2> size_px;    ///< instead of the remembered one
    std::filesystem::path ui_map, trace;  ///< empty: not written
    ShadingDevice shading{};              ///< of the mock-up's picture; automatic unless said
};

/// Runs until the window is closed; the exit code. Throws std::runtime_error without a display or
/// OpenGL 4.5, Refused when the session is open elsewhere, FileError for a wrong option.
int run_desktop(const DesktopOptions& options);

}  // namespace livery
