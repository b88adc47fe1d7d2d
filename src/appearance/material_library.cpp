#include "appearance/material_library.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/measured/measured_paint.h"
#include "appearance/measured/measured_reflectance.h"
#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

/// File systems take 255 bytes a name.
constexpr std::size_t kLongestName = 120;

/// Levenshtein distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
        }
    }
    return row[b.size()];
}

const Material* find_in(const std::vector<Material>& paints, const std::string& name) {
    const auto found = std::find_if(paints.begin(), paints.end(), [&](const Material& material) {
        return same_paint_name(material.name, name);
    });
    return found == paints.end() ? nullptr : &*found;
}

std::vector<std::filesystem::path> material_files(const std::filesystem::path& folder,
                                                  std::error_code& error) {
    std::vector<std::filesystem::path> files;
    for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
        if (it->path().extension() == ".json") files.push_back(it->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::vector<std::filesystem::path> user_files() {
    std::error_code error;
    try {
        return material_files(user_materials_folder(), error);
    } catch (const FileError&) {
        return {};  // without a home folder no paint can have been saved
    }
}

FileStamp stamp_of(const std::filesystem::path& file) {
    std::error_code error, other_error;
    const auto changed_at = std::filesystem::last_write_time(file, error);
    const auto bytes = std::filesystem::file_size(file, other_error);
    if (error || other_error) return {};
    return {changed_at, static_cast<std::int64_t>(bytes)};
}

std::filesystem::path absolute_path(const std::filesystem::path& file) {
    return std::filesystem::absolute(file).lexically_normal();
}

FileError no_such_paint(const PaintLibrary& library, const std::string& name) {
    std::string found = fmt::format("no paint named '{}'", name);
    if (!library.problems.empty()) {
        found += fmt::format(" (left out: {})", fmt::join(library.problems, "; "));
    }
    std::vector<std::string> nearest = library.nearest(name, 3);
    for (std::string& near : nearest) near = "'" + near + "'";
    const bool is_empty = library.shipped.empty();
    return FileError(
        is_empty ? std::filesystem::path("materials") : library.shipped.front().file.parent_path(),
        "",
        found,
        fmt::format("a file or a paint of the library; nearest: {}", fmt::join(nearest, ", ")));
}

/// One library in the making.
struct Reading {
    PaintLibrary library;
    const PaintLibrary* before = nullptr;

    /// What lies in the file, read anew unless it is as it was.
    void read_measured(const std::filesystem::path& file) {
        if (library.measured.contains(file)) return;
        const FileStamp stamp = library.stamps[file] = stamp_of(file);
        if (before) {
            const auto known = before->measured.find(file);
            if (known != before->measured.end() && before->stamps.at(file) == stamp) {
                library.measured.insert(*known);
                return;
            }
        }
        try {
            library.measured[file] = read_measured_paint(file);
        } catch (const FileError& error) {
            library.measured[file] = failed_measured_paint(file, error.what());
        }
    }

    void read_file(const std::filesystem::path& file, bool with_measured) {
        PaintFile& paint = library.files[file];
        library.stamps[file] = stamp_of(file);
        try {
            paint.material = read_paint_file(file);
            if (with_measured && !is_read(paint.material)) {
                read_measured(paint.material.measured->file);
            }
            paint.material = resolved(std::move(paint.material), library);
            paint.problem = paint.material.measured ? paint.material.measured->problem : "";
        } catch (const FileError& error) {
            paint.problem = error.what();
        }
    }

    void read_users(const std::filesystem::path& file) {
        library.stamps[file] = stamp_of(file);
        try {
            Material material = resolved(read_paint_file(file), library);
            if (material.measured && !material.measured->problem.empty()) {
                library.problems.push_back(material.measured->problem);
                return;
            }
            if (const Material* other = library.find(material.name)) {
                throw FileError(file,
                                "name",
                                fmt::format("'{}'", material.name),
                                fmt::format("a name that {} does not have; change it in one of "
                                            "the files",
                                            other->file.string()));
            }
            (is_read(material) ? library.users : library.unread).push_back(std::move(material));
        } catch (const FileError& problem) {
            library.problems.emplace_back(problem.what());
        }
    }
};

/// Whether every file is as the library has it, and there is none that it does not have.
bool is_current(const PaintLibrary& library, const std::set<std::filesystem::path>& wanted) {
    std::error_code error;
    std::set<std::filesystem::path> files;
    for (const char* folder : {"materials", "materials/translucent"}) {
        for (auto& file : material_files(shipped_path(folder), error)) files.insert(file);
    }
    for (auto& file : user_files()) files.insert(file);
    for (const auto& [file, paint] : library.files) files.insert(file);
    for (const auto& [file, paint] : library.measured) files.insert(file);
    const auto has = [&](const std::filesystem::path& file) {
        const auto paint = library.files.find(absolute_path(file));
        return paint != library.files.end() && is_read(paint->second.material);
    };
    return std::all_of(wanted.begin(), wanted.end(), has) &&
           std::equal(files.begin(),
                      files.end(),
                      library.stamps.begin(),
                      library.stamps.end(),
                      [](const auto& file, const auto& stamped) {
                          return file == stamped.first && stamp_of(file) == stamped.second;
                      });
}

void check_name(const std::string& name) {
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20u; };
    check_argument(name.find_first_not_of(' ') != std::string::npos, "a paint needs a name");
    check_argument(name.size() <= kLongestName,
                   fmt::format("'{}...' is too long for a paint's name: {} bytes, at most {}",
                               name.substr(0, 20),
                               name.size(),
                               kLongestName));
    // Either would be taken for a file when the paint is looked up.
    check_argument(name.find('/') == std::string::npos &&
                       !plain_paint_name(name).ends_with(".json") &&
                       std::none_of(name.begin(), name.end(), control),
                   fmt::format("'{}' is not a paint's name: it looks like a file", name));
}

}  // namespace

const std::vector<std::string>& paint_families() {
    static const std::vector<std::string> families{
        "solid", "metallic", "pearl", "matte", "plastic", "rubber", "chrome", "brushed", "glass"};
    return families;
}

std::filesystem::path user_materials_folder() { return user_folder() / "materials"; }

std::string plain_paint_name(std::string name) {
    for (char& c : name) {
        c = c == '-' || c == '_' ? ' '
                                 : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return name;
}

bool same_paint_name(const std::string& a, const std::string& b) {
    return plain_paint_name(a) == plain_paint_name(b);
}

const Material* PaintLibrary::find(const std::string& name) const {
    for (const auto* paints : {&shipped, &media, &users, &unread}) {
        if (const Material* material = find_in(*paints, name)) return material;
    }
    return nullptr;
}

std::vector<std::string> PaintLibrary::nearest(const std::string& name, std::size_t count) const {
    std::vector<std::pair<std::size_t, std::string>> ranked;
    for (const auto* paints : {&shipped, &media, &users, &unread}) {
        for (const Material& material : *paints) {
            ranked.emplace_back(
                edit_distance(plain_paint_name(name), plain_paint_name(material.name)),
                material.name);
        }
    }
    std::sort(ranked.begin(), ranked.end());
    if (ranked.size() > count) ranked.resize(count);
    std::vector<std::string> names;
    for (const auto& [distance, candidate] : ranked) names.push_back(candidate);
    return names;
}

NamedPaint look_up(const PaintLibrary& library, const std::string& name_or_file) {
    if (const Material* material = library.find(name_or_file)) return {*material, ""};
    NamedPaint none;
    none.material.name = name_or_file;
    none.material.diffuse = glm::dvec3(0.0);
    const auto file = absolute_path(name_or_file);
    if (const auto known = library.files.find(file); known != library.files.end()) {
        if (known->second.problem.empty()) return {known->second.material, ""};
        none.problem = known->second.problem;
        return none;
    }
    if (names_paint_file(name_or_file)) {
        none.material.model = ReflectanceModel::measured;
        none.material.measured = unread_measured_paint(file);
        none.material.file = file;
        return none;
    }
    none.problem = no_such_paint(library, name_or_file).what();
    return none;
}

bool names_paint_file(const std::string& name_or_file) {
    const std::filesystem::path file(name_or_file);
    return is_measured_file(file) || file.has_parent_path() ||
           plain_paint_name(file.extension().string()) == ".json";
}

Material resolved(Material material, const PaintLibrary& library) {
    if (!material.measured) return material;
    const auto known = library.measured.find(material.measured->file);
    if (known != library.measured.end()) material.measured = known->second;
    return material;
}

std::vector<Material> read_paint_folder(const std::filesystem::path& folder) {
    std::error_code error;
    const auto files = material_files(folder, error);
    if (error) throw FileError(folder, "", error.message(), "a folder of material files");
    std::vector<Material> paints;
    for (const auto& file : files) {
        Material material = read_material_file(file);
        if (const Material* other = find_in(paints, material.name)) {
            throw FileError(
                file,
                "name",
                fmt::format("'{}'", material.name),
                fmt::format("a name that {} does not have", other->file.filename().string()));
        }
        paints.push_back(std::move(material));
    }
    return paints;
}

std::shared_ptr<const PaintLibrary> read_paint_library(
    const std::shared_ptr<const PaintLibrary>& before,
    const std::set<std::filesystem::path>& wanted) {
    if (before && is_current(*before, wanted)) return before;
    Reading reading{{}, before.get()};
    PaintLibrary& library = reading.library;
    library.shipped = read_paint_folder(shipped_path("materials"));
    const auto place = [](const Material& material) {
        const auto& families = paint_families();
        return std::find(families.begin(), families.end(), material.family) - families.begin();
    };
    std::stable_sort(library.shipped.begin(),
                     library.shipped.end(),
                     [&](const Material& a, const Material& b) { return place(a) < place(b); });
    library.media = read_paint_folder(shipped_path("materials/translucent"));
    for (const auto* paints : {&library.shipped, &library.media}) {
        for (const Material& paint : *paints) library.stamps[paint.file] = stamp_of(paint.file);
    }
    if (before) {
        for (const auto& [file, paint] : before->measured) reading.read_measured(file);
    }
    for (const auto& file : wanted) reading.read_file(absolute_path(file), true);
    if (before) {
        for (const auto& [file, paint] : before->files) {
            if (!library.files.contains(file)) reading.read_file(file, false);
        }
    }
    for (const auto& file : user_files()) reading.read_users(file);
    return std::make_shared<const PaintLibrary>(std::move(library));
}

std::shared_ptr<const PaintLibrary> read_whole_paint_library() {
    const auto library = read_paint_library();
    std::set<std::filesystem::path> wanted;
    for (const Material& paint : library->unread) wanted.insert(paint.measured->file);
    return read_paint_library(library, wanted);
}

Material find_material(const std::string& name_or_file, const PaintLibrary& library) {
    if (names_paint_file(name_or_file)) return with_measured_read(read_paint_file(name_or_file));
    // A bare name is the library's where it has it, whatever lies in the folder where the program
    // runs.
    if (const Material* paint = library.find(name_or_file)) return with_measured_read(*paint);
    std::error_code error;
    if (std::filesystem::is_regular_file(name_or_file, error)) {
        return with_measured_read(read_paint_file(name_or_file));
    }
    throw no_such_paint(library, name_or_file);
}

Material find_material(const std::string& name_or_file) {
    if (names_paint_file(name_or_file)) return with_measured_read(read_paint_file(name_or_file));
    return find_material(name_or_file, *read_paint_library());
}

std::filesystem::path save_to_library(const Material& material) {
    check_name(material.name);
    const auto library = read_paint_library();
    if (const Material* other = library->find(material.name)) {
        throw Refused(
            fmt::format(
                "the library has a paint '{}' already ({})", other->name, other->file.string()),
            "choose another name");
    }
    const auto folder = user_materials_folder();
    make_output_folder(folder);
    std::string stem = plain_paint_name(material.name);
    std::replace(stem.begin(), stem.end(), ' ', '-');
    if (stem.front() == '.') stem.front() = '-';
    auto file = folder / (stem + ".json");
    // A file that was left out of the library may stand there.
    for (int number = 2; std::filesystem::exists(file); ++number) {
        file = folder / fmt::format("{}-{}.json", stem, number);
    }
    write_material_file(file, material);
    return file;
}

}  // namespace livery
