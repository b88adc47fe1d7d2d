// Files that a model or a look names. Internal to mesh/.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace livery {

/// A file that `model` names, beside it or below its folder. Nothing for names elsewhere (absolute,
/// above, on the network): a model from a stranger must not open other files.
std::optional<std::filesystem::path> path_beside(const std::filesystem::path& model,
                                                 const std::string& name);

/// What a look names: as it is where that is a whole path, else in `folder`, else shipped. Throws
/// FileError that says of `field` that it wants `expected`.
std::filesystem::path find_beside_or_shipped(const std::string& name,
                                             const std::filesystem::path& folder,
                                             const char* field,
                                             const char* expected);

}  // namespace livery
