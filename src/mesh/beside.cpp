#include "mesh/beside.h"

#include "core/error.h"
#include "core/paths.h"

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

std::filesystem::path find_beside_or_shipped(const std::string& name,
                                             const std::filesystem::path& folder,
                                             const char* field,
                                             const char* expected) {
    const std::filesystem::path file = name;
    if (file.is_absolute()) return file;
    std::error_code error;
    if (std::filesystem::is_regular_file(folder / file, error)) return folder / file;
    try {
        return shipped_path(file);
    } catch (const FileError& missing) {
        const auto place = folder.empty() ? std::filesystem::path(".") : folder;
        throw FileError(file, field, missing.found() + ", nor in " + place.string(), expected);
    }
}

}  // namespace livery
