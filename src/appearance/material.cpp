#include "appearance/material.h"

#include <algorithm>
#include <cctype>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

std::string lower_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

/// "Solid-Red" and "solid red" are one name.
std::string plain(std::string text) {
    text = lower_case(std::move(text));
    std::replace(text.begin(), text.end(), '-', ' ');
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
}

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

std::vector<std::string> nearest_names(const std::string& name,
                                       const std::vector<Material>& library,
                                       std::size_t count) {
    std::vector<std::pair<std::size_t, std::string>> ranked;
    for (const Material& material : library) {
        ranked.emplace_back(edit_distance(plain(name), plain(material.name)), material.name);
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) {
        names.push_back("'" + ranked[i].second + "'");
    }
    return names;
}

}  // namespace

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
            if (plain(other.name) == plain(material.name)) {
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
    if (lower_case(file.extension().string()) == ".json" ||
        std::filesystem::is_regular_file(file, error)) {
        return read_material_file(file);
    }
    const std::filesystem::path folder = shipped_path("materials");
    const std::vector<Material> library = load_library(folder);
    for (const Material& material : library) {
        if (plain(material.name) == plain(name_or_file)) return material;
    }
    throw FileError(folder,
                    "",
                    fmt::format("no paint named '{}'", name_or_file),
                    fmt::format("a file or a paint of the library; nearest: {}",
                                fmt::join(nearest_names(name_or_file, library, 3), ", ")));
}

}  // namespace livery
