// Files that a model names. Internal to scene/.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace livery {

/// A file that `model` names, beside it or below its folder. Nothing for names elsewhere (absolute,
/// above, on the network): a model from a stranger must not open other files.
std::optional<std::filesystem::path> path_beside(const std::filesystem::path& model,
                                                 const std::string& name);

}  // namespace livery
