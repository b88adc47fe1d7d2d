#include "scene/library.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <mutex>

#include "core/error.h"
#include "core/json.h"
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

/// A bare name is a shipped thing's where there is one of that name, whatever lies in the folder
/// where the program runs.
bool is_shipped(const std::string& name, const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), file_stem_of(name)) != names.end();
}

bool is_file(const std::string& name) {
    std::error_code error;
    const bool looks_like_path =
        name.find('/') != std::string::npos || !std::filesystem::path(name).extension().empty();
    return looks_like_path || std::filesystem::is_regular_file(name, error);
}

/// Part names of the products that were read in this run, as they were last read.
class KnownParts {
  public:
    std::optional<std::vector<std::string>> of(const std::string& product) {
        const std::lock_guard lock(mutex_);
        const auto found = names_.find(product);
        if (found == names_.end()) return std::nullopt;
        return found->second;
    }

    void keep(const std::string& product, std::vector<std::string> names) {
        const std::lock_guard lock(mutex_);
        names_.insert_or_assign(product, std::move(names));
    }

  private:
    std::mutex mutex_;
    std::map<std::string, std::vector<std::string>> names_;
};

KnownParts& known_parts() {
    static KnownParts known;
    return known;
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
    if (!is_shipped(name_or_file, shipped_looks()) && is_file(name_or_file)) {
        return read_look_file(name_or_file);
    }
    return read_look_file(shipped_look_file(name_or_file));
}

Look find_look_for(const std::string& name_or_file, const std::vector<std::string>& parts) {
    Look look = find_look(name_or_file);
    if (!is_shipped(name_or_file, shipped_looks()) && is_file(name_or_file)) return look;
    const auto has_part = [&](const std::string& name) {
        return std::find(parts.begin(), parts.end(), name) != parts.end();
    };
    const auto body = look.parts.find("body");
    const std::string body_paint = body == look.parts.end() ? "" : body->second;
    std::erase_if(look.parts,
                  [&](const auto& entry) { return entry.first != "*" && !has_part(entry.first); });
    if (!body_paint.empty() && !look.parts.contains("body")) look.parts["*"] = body_paint;
    return look;
}

std::vector<Look> own_looks(const Mesh& mesh) {
    const bool pictures = std::any_of(mesh.parts.begin(), mesh.parts.end(), [](const Part& part) {
        return !part.pictures.empty();
    });
    if (!pictures && mesh.variants.empty()) return {};
    Look look = find_look(shipped_looks().at(0));
    look.parts.clear();
    look.artwork.clear();
    look.file.clear();
    look.name = "as it comes";
    std::vector<Look> looks{look};
    for (const MeshVariant& variant : mesh.variants) {
        look.name = look.variant = variant.name;
        looks.push_back(look);
    }
    return looks;
}

Look find_look_for(const std::string& name_or_file, const Mesh& mesh) {
    if (!is_shipped(name_or_file, shipped_looks()) && !is_file(name_or_file)) {
        for (Look& look : own_looks(mesh)) {
            if (look.name == name_or_file) return look;
        }
    }
    return find_look_for(name_or_file, part_names(mesh));
}

std::optional<std::string> bench_of_shipped_product(const std::string& name) {
    static const std::map<std::string, std::string> benches{
        {"car", "default"}, {"player", "player"}, {"sphere", "sphere"}};
    const auto bench = benches.find(name);
    if (bench == benches.end()) return std::nullopt;
    return bench->second;
}

std::shared_ptr<const Product> find_product(const std::string& name_or_file,
                                            std::optional<LengthUnit> unit) {
    const std::string stem = file_stem_of(name_or_file);
    const bool shipped = bench_of_shipped_product(stem).has_value();
    if (!shipped && !is_file(name_or_file)) {
        throw FileError(name_or_file,
                        "product",
                        "no such file or shipped product",
                        "a file, car, player or sphere");
    }
    if (shipped && unit) {
        throw FileError(name_or_file, "unit", to_string(*unit), "none for a shipped product");
    }
    auto product = std::make_shared<const Product>(
        shipped ? load_product(shipped_path("assets/" + stem + ".json"))
                : load_product(name_or_file, unit));
    known_parts().keep(name_or_file, part_names(product->mesh));
    return product;
}

std::vector<std::string> part_names(const Mesh& mesh) {
    std::vector<std::string> names;
    for (const Part& part : mesh.parts) names.push_back(part.name);
    return names;
}

std::vector<std::string> part_names(const std::string& product_name_or_file) {
    // Every command that names a part asks; the mesh takes a tenth of a second to read.
    if (auto known = known_parts().of(product_name_or_file)) return *std::move(known);
    return part_names(find_product(product_name_or_file)->mesh);
}

std::string front_of_product(const std::string& name_or_file) {
    static std::mutex mutex;
    static std::map<std::string, std::string> known;
    const std::lock_guard lock(mutex);
    const auto found = known.find(name_or_file);
    if (found != known.end()) return found->second;
    const std::string stem = file_stem_of(name_or_file);
    const std::filesystem::path file = bench_of_shipped_product(stem)
                                           ? shipped_path("assets/" + stem + ".json")
                                           : std::filesystem::path(name_or_file);
    std::string front;
    if (file.extension() == ".json") {
        const Json json = read_json_file(file);
        if (json.is_object() && json.contains("front"))
            front = JsonReader(file, json)["front"].text();
    }
    return known.emplace(name_or_file, front).first->second;
}

}  // namespace livery
