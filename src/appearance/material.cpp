#include "appearance/material.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/material_library.h"
#include "appearance/measured_paint.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

std::vector<Material> load_library(const std::filesystem::path& folder) {
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
        if (it->path().extension() == ".json") files.push_back(it->path());
    }
    if (error) throw FileError(folder, "", error.message(), "a folder of material files");
    std::sort(files.begin(), files.end());
    std::vector<Material> library;
    for (const auto& file : files) {
        Material material = read_material_file(file);
        for (const Material& other : library) {
            if (same_paint_name(other.name, material.name)) {
                throw FileError(
                    file,
                    "name",
                    fmt::format("'{}'", material.name),
                    fmt::format("a name that {} does not have", other.file.filename().string()));
            }
        }
        library.push_back(std::move(material));
    }
    return library;
}

Material find_material(const std::string& name_or_file) {
    std::error_code error;
    const std::filesystem::path file(name_or_file);
    std::string suffix = file.extension().string();
    for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (is_measured_file(file)) {
        Material material;
        material.name = file.stem().string();
        material.model = ReflectanceModel::measured;
        material.measured = load_measured_paint(file);
        material.file = file;
        return material;
    }
    if (suffix == ".json" || std::filesystem::is_regular_file(file, error)) {
        return read_material_file(file);
    }
    const PaintLibrary library = read_paint_library();
    if (const Material* material = library.find(name_or_file)) return *material;
    std::string found = fmt::format("no paint named '{}'", name_or_file);
    if (!library.problems.empty()) {
        found += fmt::format(" (left out: {})", fmt::join(library.problems, "; "));
    }
    std::vector<std::string> nearest = library.nearest(name_or_file, 3);
    for (std::string& name : nearest) name = "'" + name + "'";
    throw FileError(
        shipped_path("materials"),
        "",
        found,
        fmt::format("a file or a paint of the library; nearest: {}", fmt::join(nearest, ", ")));
}

}  // namespace livery
