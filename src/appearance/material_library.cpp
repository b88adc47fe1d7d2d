#include "appearance/material_library.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "appearance/measured/measured_paint.h"
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

std::vector<std::filesystem::path> user_files() {
    std::vector<std::filesystem::path> files;
    std::filesystem::path folder;
    try {
        folder = user_materials_folder();
    } catch (const FileError&) {
        return files;  // without a home folder no paint can have been saved
    }
    std::error_code error;
    for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
        if (it->path().extension() == ".json") files.push_back(it->path());
    }
    std::sort(files.begin(), files.end());
    return files;
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
    const Material* material = find_in(shipped, name);
    return material ? material : find_in(users, name);
}

std::vector<std::string> PaintLibrary::nearest(const std::string& name, std::size_t count) const {
    std::vector<std::pair<std::size_t, std::string>> ranked;
    for (const auto* paints : {&shipped, &users}) {
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

std::vector<Material> read_shipped_paints() {
    std::vector<Material> paints = load_library(shipped_path("materials"));
    const auto place = [](const Material& material) {
        const auto& families = paint_families();
        return std::find(families.begin(), families.end(), material.family) - families.begin();
    };
    std::stable_sort(paints.begin(), paints.end(), [&](const Material& a, const Material& b) {
        return place(a) < place(b);
    });
    return paints;
}

PaintLibrary read_paint_library() {
    PaintLibrary library;
    library.shipped = read_shipped_paints();
    for (const auto& file : user_files()) {
        try {
            Material material = read_material_file(file);
            if (const Material* other = library.find(material.name)) {
                throw FileError(file,
                                "name",
                                fmt::format("'{}'", material.name),
                                fmt::format("a name that {} does not have; change it in one of "
                                            "the files",
                                            other->file.string()));
            }
            library.users.push_back(std::move(material));
        } catch (const MeasuredFileUnread& unread) {
            library.unread.push_back(unread.file());
        } catch (const FileError& problem) {
            library.problems.emplace_back(problem.what());
        }
    }
    return library;
}

std::filesystem::path save_to_library(const Material& material) {
    check_name(material.name);
    if (const PaintLibrary library = read_paint_library();
        const Material* other = library.find(material.name)) {
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
