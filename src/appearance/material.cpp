#include "appearance/material.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/material_library.h"
#include "appearance/measured/measured_paint.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

/// A file of the library as it was when it was last read: dozens of them are looked through
/// whenever a paint is asked for by name.
struct KeptFile {
    std::filesystem::file_time_type changed_at;
    std::uintmax_t bytes = 0;
    Material material;
};

Material read_or_remember(const std::filesystem::path& file) {
    static std::mutex mutex;
    static std::map<std::filesystem::path, KeptFile> kept;
    std::error_code error, other_error;
    const auto changed_at = std::filesystem::last_write_time(file, error);
    const auto bytes = std::filesystem::file_size(file, other_error);
    if (error || other_error) return read_material_file(file);
    {
        const std::lock_guard lock(mutex);
        const auto known = kept.find(file);
        if (known != kept.end() && known->second.changed_at == changed_at &&
            known->second.bytes == bytes) {
            return known->second.material;
        }
    }
    Material material = read_material_file(file);
    // What a measured paint was measured in may change while its material does not.
    if (!material.measured) {
        const std::lock_guard lock(mutex);
        kept[file] = {changed_at, bytes, material};
    }
    return material;
}

}  // namespace

bool has_glints(const Material& material) {
    return material.model == ReflectanceModel::car_paint && material.glint_density_per_mm2 > 0.0;
}

std::string glint_scale_text(const Material& material) {
    return material.glint_scale > 1.0
               ? fmt::format("exaggerated {:.3g} times", material.glint_scale)
               : "physical";
}

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
        Material material = read_or_remember(file);
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
    if (suffix == ".json" || file.has_parent_path()) return read_material_file(file);
    // A bare name is the library's where it has it, whatever lies in the folder where the program
    // runs.
    const PaintLibrary library = read_paint_library();
    if (const Material* material = library.find(name_or_file)) return *material;
    if (std::filesystem::is_regular_file(file, error)) return read_material_file(file);
    // Which names they have is not known yet.
    if (!library.unread.empty()) throw MeasuredFileUnread(library.unread.front());
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
