#include "live/calibration_reuse.h"

#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/hash.h"
#include "core/json.h"
#include "core/paths.h"
#include "live/projector_setup.h"
#include "twin/description.h"

namespace livery {

namespace {

/// Rises when a calibration on the same bench comes out differently.
constexpr int kReuseVersion = 5;
constexpr const char* kNote = "bench.json";
constexpr std::size_t kLargestNamedFile_bytes = std::size_t{1} << 30u;

/// A file with all that it names, each once.
class FileHasher {
  public:
    explicit FileHasher(Hasher& hasher) : hasher_(hasher) {}

    void add(const std::filesystem::path& file) {
        if (!seen_.insert(file.lexically_normal()).second) return;
        const std::string text = read_text_file(file, kLargestNamedFile_bytes);
        hasher_.add(fmt::format("{} {}\n", file.filename().string(), text.size()));
        hasher_.add(text);
        if (file.extension() == ".json") add_named(parse_json(text, file), file.parent_path());
    }

  private:
    void add_named(const Json& json, const std::filesystem::path& folder) {
        if (json.is_structured()) {
            for (const Json& one : json) add_named(one, folder);
        }
        if (!json.is_string()) return;
        // "paints.csv#column"
        const auto name = json.get<std::string>();
        const std::filesystem::path own = name.substr(0, name.find('#'));
        if (own.empty()) return;
        for (const auto& there : {folder / own, shipped_folder() / own}) {
            std::error_code error;
            if (std::filesystem::is_regular_file(there, error)) return add(there);
        }
    }
    static std::filesystem::path shipped_folder() { return shipped_path("calibration"); }

    Hasher& hasher_;
    std::set<std::filesystem::path> seen_;
};

}  // namespace

std::string bench_key(const std::string& bench, const Product& product) {
    Hasher hasher;
    hasher.add(fmt::format("{} {}\n", kReuseVersion, LIVERY_VERSION));
    FileHasher(hasher).add(read_bench_file(bench).file);
    hasher.add(shape_hash(product.mesh));
    for (const Part& part : product.mesh.parts) hasher.add(part.name + "\n");
    return hasher.hex();
}

void note_bench(const std::filesystem::path& calibration, const std::string& key) {
    const Json json = {{"format_version", 1}, {"made_on", key}};
    write_text_file(calibration / kNote, json.dump(2) + "\n");
}

std::optional<std::filesystem::path> kept_calibration_of(const std::string& key) {
    for (const auto& folder : kept_calibrations()) {
        const auto file = folder / kNote;
        std::error_code error;
        if (!std::filesystem::exists(file, error)) continue;
        try {
            const Json json = read_json_file(file);
            const JsonReader note(file, json);
            note.require_format_version(1);
            if (note["made_on"].text() == key) return folder;
        } catch (const FileError&) {
            // What cannot be read says nothing about where it was made.
        }
    }
    return std::nullopt;
}

}  // namespace livery
