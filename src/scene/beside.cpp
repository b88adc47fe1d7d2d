#include "scene/beside.h"

namespace livery {

std::optional<std::filesystem::path> path_beside(const std::filesystem::path& model,
                                                 const std::string& name) {
    const auto normal = std::filesystem::path(name).lexically_normal();
    // A name with a zero byte would end there for the system.
    if (name.find("://") != std::string::npos || name.find('\0') != std::string::npos ||
        normal.is_absolute() || normal.empty() || *normal.begin() == "..") {
        return std::nullopt;
    }
    return model.parent_path() / normal;
}

}  // namespace livery
