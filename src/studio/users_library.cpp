#include "studio/users_library.h"

#include <system_error>

#include "core/error.h"

namespace livery {

namespace {

constexpr double kBetweenLooks_s = 2.0;

}  // namespace

const PaintLibrary& current_library(Studio& studio) {
    LibraryPanelState& state = studio.panels.library;
    const bool read_before = state.read_at_s >= 0.0;
    if (read_before && studio.now_s - state.read_at_s < kBetweenLooks_s) return state.library;
    state.read_at_s = studio.now_s;
    std::error_code none;
    try {
        const auto changed_at = std::filesystem::last_write_time(user_materials_folder(), none);
        if (read_before && changed_at == state.folder_changed_at) return state.library;
        state.folder_changed_at = changed_at;
        state.problem.clear();
        state.library = read_paint_library();
    } catch (const FileError& error) {
        state.problem = error.what();
    }
    return state.library;
}

}  // namespace livery
