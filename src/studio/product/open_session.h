// Another session in the same window: opened, dropped on it, or one of the last.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studio/kit/user_settings.h"

namespace livery {

struct Studio;

/// Opens it in the background; the window then goes on with it. Where it cannot be opened a notice
/// says why and the session that is open stays; one that another start has open has its window
/// asked for.
void open_other_session(Studio& studio, const std::filesystem::path& file);
/// Asks for the file first.
void ask_for_session(Studio& studio);

/// What came from another program: a session opens, a mesh or product file begins a new session,
/// for anything else a notice says what can be dropped.
void take_dropped_files(Studio& studio, const std::vector<std::filesystem::path>& files);

/// Why another session may not take this one's place: something in it is on no disk. A sentence;
/// empty: it may.
std::string why_not_to_leave(const Studio& studio);

/// Leaves the session by `then`, in words `doing` ("Opening car.livery") and on a button `action`
/// ("Stop and open"). A calibration or a capture that this would stop is asked about first.
void leave_session(Studio& studio,
                   const std::string& doing,
                   const std::string& action,
                   std::function<void()> then);

/// The newest first.
std::vector<std::filesystem::path> recent_sessions(const UserSettings& settings);
void remember_recent_session(UserSettings& settings, const std::filesystem::path& file);
inline constexpr std::size_t kMostRecentSessions = 10;

}  // namespace livery
