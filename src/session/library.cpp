#include "session/library.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>

#include "core/error.h"
#include "core/paths.h"

namespace livery {

namespace {

/// "Solid Red" -> "solid-red", as the shipped files are called.
std::string file_stem_of(const std::string& name) {
    std::string stem;
    for (const char c : name) {
        stem += c == ' ' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return stem;
}

bool is_file(const std::string& name) {
    std::error_code error;
    return std::filesystem::is_regular_file(name, error);
}

bool looks_like_path(const std::string& name) {
    return name.find('/') != std::string::npos || !std::filesystem::path(name).extension().empty();
}

}  // namespace

std::vector<std::string> shipped_looks() { return shipped_names("assets/looks"); }

std::filesystem::path shipped_look_file(const std::string& name) {
    const auto names = shipped_looks();
    const std::string stem = file_stem_of(name);
    if (std::find(names.begin(), names.end(), stem) == names.end()) {
        throw FileError(
            name, "look", "no such file or shipped look", "a file or " + list_of(names));
    }
    return shipped_path("assets/looks") / (stem + ".json");
}

Look find_look(const std::string& name_or_file) {
    if (is_file(name_or_file) || looks_like_path(name_or_file)) return read_look_file(name_or_file);
    return read_look_file(shipped_look_file(name_or_file));
}

std::shared_ptr<const Product> find_product(const std::string& name_or_file) {
    if (is_file(name_or_file) || looks_like_path(name_or_file)) {
        return std::make_shared<const Product>(load_product(name_or_file));
    }
    const std::string stem = file_stem_of(name_or_file);
    if (stem != "car" && stem != "sphere") {
        throw FileError(
            name_or_file, "product", "no such file or shipped product", "a file, car or sphere");
    }
    return std::make_shared<const Product>(load_product(shipped_path("assets/" + stem + ".json")));
}

std::vector<std::string> part_names(const std::string& product_name_or_file) {
    // Every command that names a part asks; the mesh takes a tenth of a second to read.
    static std::mutex mutex;
    static std::map<std::string, std::vector<std::string>> known;
    const std::lock_guard lock(mutex);
    auto entry = known.find(product_name_or_file);
    if (entry == known.end()) {
        const auto product = find_product(product_name_or_file);
        std::vector<std::string> names;
        for (const Part& part : product->mesh.parts) names.push_back(part.name);
        entry = known.emplace(product_name_or_file, std::move(names)).first;
    }
    return entry->second;
}

}  // namespace livery
