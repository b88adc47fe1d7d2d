// Taking out of a text who somebody is: the home folder and the user's names.
#pragma once

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

}  // namespace livery
