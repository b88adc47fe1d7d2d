#include "studio/paint/users_library.h"

#include <system_error>

#include "appearance/measured/measured_paint.h"
#include "core/error.h"
#include "studio/kit/background.h"

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
        const OnlyMeasuredInMemory no_waiting;
        state.library = read_paint_library();
        for (const auto& file : state.library.unread) read_measured_behind(studio, file);
    } catch (const FileError& error) {
        state.problem = error.what();
    }
    return state.library;
}

void read_measured_behind(Studio& studio, const std::filesystem::path& file) {
    if (!studio.panels.library.being_read.insert(file).second) return;
    const auto done = [&studio, file] {
        LibraryPanelState& state = studio.panels.library;
        state.being_read.erase(file);
        state.read_at_s = -1.0;
        current_library(studio);
    };
    studio.background->run(
        [&studio, file, done](const Progress&) -> Background::Then {
            return [&studio, done, paint = load_measured_paint(file)] {
                studio.panels.library.just_read.push_back(paint);
                done();
            };
        },
        // Whoever needs the file is told why it cannot be read when it is asked for again.
        [done](std::exception_ptr) { done(); });
}

}  // namespace livery
