// The log's end as a report tells it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace livery {

/// The last `most_bytes` of `log/livery.log` in the user's folder and of those it was rotated to,
/// oldest first, in whole lines. `with_session`: else of commands, undo and redo, which tell of the
/// session, only the kind. Throws FileError where there is no log.
std::string log_part(const std::filesystem::path& user_folder,
                     bool with_session,
                     std::size_t most_bytes = 1u << 20u);

}  // namespace livery
