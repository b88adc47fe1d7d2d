// Taking out of a text who somebody is, and the log's end as a report tells it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace livery {

/// What must not be read in a report, each with what stands in its place.
struct PrivateWords {
    /// Folders, replaced with all that they are the beginning of, longest first.
    std::vector<std::pair<std::string, std::string>> folders;
    std::vector<std::pair<std::string, std::string>> words;  ///< replaced as whole words only
};

/// Of this process: the home folder ("~"), also as links lead to it; the account's name and its
/// owner's ("USER"), also of who became root through sudo; the machine's name ("HOST"). Names that
/// are nobody's (root, livery, localhost) stay.
PrivateWords private_words();

/// The text with all of them replaced, as they are and as JSON writes them.
std::string redacted(const std::string& text, const PrivateWords& words);

/// The last `most_bytes` of `log/livery.log` in the user's folder and of those it was rotated to,
/// oldest first, in whole lines. `with_session`: else of commands, undo and redo, which tell of the
/// session, only the kind. Throws FileError where there is no log.
std::string log_part(const std::filesystem::path& user_folder,
                     bool with_session,
                     std::size_t most_bytes = 1u << 20u);

}  // namespace livery
