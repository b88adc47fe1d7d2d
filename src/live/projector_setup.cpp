#include "live/projector_setup.h"

#include <algorithm>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/cache.h"
#include "core/error.h"
#include "core/hash.h"
#include "core/json.h"
#include "core/log.h"
#include "core/paths.h"
#include "core/replace_folder.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/reposed_calibration.h"
#include "scene/mockup_mask.h"
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

namespace {

/// Rises when what is kept, or how it is worked out from a calibration, changes.
constexpr int kSetupVersion = 4;

/// Values one after the other into bytes.
class Writer {
  public:
    template <typename T>
    void operator()(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <typename T>
    void operator()(const std::vector<T>& values) {
        (*this)(static_cast<std::uint64_t>(values.size()));
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
    void operator()(const std::vector<std::string>& texts) {
        (*this)(static_cast<std::uint64_t>(texts.size()));
        for (const std::string& text : texts) (*this)(text);
    }
    void operator()(const std::string& text) {
        (*this)(std::vector<char>(text.begin(), text.end()));
    }

    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

/// And back. Throws std::runtime_error where they end too early.
class Reader {
  public:
    explicit Reader(std::string_view bytes) : bytes_(bytes) {}

    template <typename T>
    void operator()(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        copy(&value, sizeof value);
    }
    template <typename T>
    void operator()(std::vector<T>& values) {
        values.resize(count(sizeof(T)));
        copy(values.data(), values.size() * sizeof(T));
    }
    void operator()(std::vector<std::string>& texts) {
        texts.resize(count(sizeof(std::uint64_t)));
        for (std::string& text : texts) (*this)(text);
    }
    void operator()(std::string& text) {
        std::vector<char> letters;
        (*this)(letters);
        text.assign(letters.begin(), letters.end());
    }
    bool at_end() const { return bytes_.empty(); }

  private:
    void copy(void* to, std::size_t size) {
        if (size > bytes_.size()) throw std::runtime_error("it ends too early");
        if (size > 0) std::memcpy(to, bytes_.data(), size);
        bytes_.remove_prefix(size);
    }
    std::size_t count(std::size_t least_bytes_each) {
        std::uint64_t number = 0;
        (*this)(number);
        if (number > bytes_.size() / least_bytes_each)
            throw std::runtime_error("it ends too early");
        return static_cast<std::size_t>(number);
    }
    std::string_view bytes_;
};

/// The same order for both ways. What load_setup() drops is not kept.
template <typename Archive, typename Calibration>
void visit_calibration(Archive& archive, Calibration& c) {
    archive(c.width);
    archive(c.height);
    archive(c.id);
    archive(c.created);
    archive(c.mode);
    archive(c.made_with);
    archive(c.dark_drive);
    archive(c.bright_drive);
    archive(c.status.width);
    archive(c.status.height);
    archive(c.status.channels);
    archive(c.status.values);
    for (auto& curve : c.response) {
        archive(curve.drive_from_n);
        archive(curve.largest_violation);
    }
    archive(c.table.grid);
    archive(c.table.n_from_drive);
    archive(c.xyz_from_camera);
    archive(c.xyz_origin);
    archive(c.camera_ambient);
    archive(c.additivity_error);
    archive(c.condition_p99);
    archive(c.valid_fraction);
    archive(c.ambient_fraction);
    archive(c.mixing_spread);
    archive(c.predicted_fraction);
    archive(c.prediction_error_median);
    archive(c.prediction_error_p95);
    archive(c.warnings);
}

template <typename Archive, typename Table>
void visit_table(Archive& archive, Table& t) {
    archive(t.width);
    archive(t.height);
    archive(t.design_white_y);
    archive(t.pixels);
    archive(t.light);
    archive(t.coefficients);
    for (auto& curve : t.drive_from_n) archive(curve);
    archive(t.non_additive.grid);
    archive(t.non_additive.n_from_nodes);
    for (auto& curve : t.non_additive.rho) archive(curve);
    for (auto& curve : t.non_additive.linear_of_node) archive(curve);
    archive(t.non_additive.start_grid);
    archive(t.non_additive.start);
    archive(t.gamut.coefficients);
    archive(t.gamut.darkest);
    archive(t.gamut.brightest);
    archive(t.gamut.own_darkest);
    archive(t.gamut.own_brightest);
    archive(t.gamut.floor_lightness);
    archive(t.calibration_id);
}

template <typename Archive, typename Setup>
void visit_setup(Archive& archive, Setup& setup) {
    archive(setup.design_white_y);
    visit_calibration(archive, *setup.calibration);
    visit_table(archive, *setup.table);
}

/// Of all that load_setup() reads, of the percentile and of the pixels that count. Throws FileError
/// for a folder or a file in it that cannot be read.
std::string setup_cache_name(const std::filesystem::path& calibration,
                             double design_white_percentile,
                             GamutMapping gamut,
                             const Image8& mockup) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(calibration, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->is_regular_file()) files.push_back(entry->path());
    }
    if (error) throw FileError(calibration, "", error.message(), "a folder that can be read");
    std::sort(files.begin(), files.end());
    Hasher hasher;
    hasher.add(fmt::format("{} {} {}", kSetupVersion, design_white_percentile, to_string(gamut)));
    hasher.add_bytes(mockup.values.data(), mockup.values.size());
    for (const auto& file : files) {
        hasher.add(file.filename().string());
        hasher.add(read_text_file(file, std::size_t{4} << 30u));
    }
    return "setup-" + hasher.hex();
}

/// All but the view. Nothing when it is not kept (core/cache.h).
std::shared_ptr<ProjectorSetup> read_kept_setup(const std::string& name) {
    const auto bytes = read_cache(name);
    if (!bytes) return nullptr;
    auto setup = std::make_shared<ProjectorSetup>();
    setup->calibration.emplace();
    setup->table.emplace();
    try {
        Reader reader(*bytes);
        visit_setup(reader, *setup);
        if (!reader.at_end()) throw std::runtime_error("it goes on past its end");
    } catch (const std::exception& error) {
        log_line(LogLevel::warning,
                 "cache: " + name + ": " + error.what() + "; what it held is worked out again");
        return nullptr;
    }
    return setup;
}

void keep_setup(const std::string& name, const ProjectorSetup& setup) {
    Writer writer;
    visit_setup(writer, setup);
    write_cache(name, writer.take());
}

std::filesystem::path calibrations_folder() { return user_folder() / "calibrations"; }

/// Gone with the object unless it was moved away: what a stop or a full disk leaves half written.
class UnfinishedFolder {
  public:
    explicit UnfinishedFolder(std::filesystem::path path) : path_(std::move(path)) {}
    ~UnfinishedFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    UnfinishedFolder(const UnfinishedFolder&) = delete;
    UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// It says what a calibration was made for and is no part of it: one that cannot be read says
/// nothing.
std::optional<CalibrationOrigin> origin_if_readable(const std::filesystem::path& folder) {
    try {
        return read_origin(folder, false);
    } catch (const FileError& error) {
        log_line(LogLevel::warning, error.what());
        return std::nullopt;
    }
}

/// What `write` writes into a folder, under a name of the date and the id that it returns.
template <typename Write>
std::filesystem::path keep(const Write& write) {
    const auto all = calibrations_folder();
    make_output_folder(all);
    const UnfinishedFolder unfinished(all / ("." + fmt::format("{}", ::getpid()) + "-unfinished"));
    const std::string id = write(unfinished.path());
    const auto folder =
        all /
        fmt::format("{:%Y-%m-%dT%H-%M-%SZ}-{}", fmt::gmtime(std::time(nullptr)), id.substr(0, 8));
    std::error_code error;
    std::filesystem::rename(unfinished.path(), folder, error);
    if (error) throw FileError(folder, "", error.message(), "a folder that can be made");
    sync_folder(all);
    return folder;
}

}  // namespace

std::shared_ptr<const ProjectorSetup> load_setup(const std::filesystem::path& folder,
                                                 double design_white_percentile,
                                                 const Mesh& mesh,
                                                 GamutMapping gamut) {
    std::error_code error;
    const auto camera_file = folder / "projector.json";
    // Folders without a projector are found out below, after what names them better.
    const bool there = std::filesystem::exists(folder / "calibration.json", error) &&
                       std::filesystem::exists(camera_file, error);
    std::string kept;
    Image8 mockup;
    if (there) {
        const View view = read_camera_file(camera_file);
        mockup = mockup_mask(mesh, view);
        kept = setup_cache_name(folder, design_white_percentile, gamut, mockup);
        if (auto setup = read_kept_setup(kept)) {
            setup->view = view;
            setup->origin = origin_if_readable(folder);
            return setup;
        }
    }
    auto setup = std::make_shared<ProjectorSetup>();
    ColourCalibration calibration = read_calibration(folder);
    setup->view = read_camera_file(camera_file);
    check_projector(setup->view, camera_file, calibration.width, calibration.height);
    setup->origin = origin_if_readable(folder);
    setup->design_white_y = design_white_luminance(calibration, design_white_percentile, mockup);
    setup->table = bake(calibration, setup->design_white_y, gamut);
    for (ImageF* plane :
         {&calibration.unmixing, &calibration.dark, &calibration.span, &calibration.camera_px}) {
        *plane = ImageF();
    }
    setup->calibration = std::move(calibration);
    keep_setup(kept, *setup);
    return setup;
}

std::shared_ptr<const ProjectorSetup> uncorrected_setup(const std::string& bench) {
    auto setup = std::make_shared<ProjectorSetup>();
    setup->view = read_bench_file(bench).projector.view;
    setup->why_uncorrected =
        "no calibration: colours go out as they are and will look wrong; calibrate to correct them";
    return setup;
}

std::filesystem::path calibrate_on_bench(const std::string& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress) {
    Bench traced(read_bench_file(bench), product, progress);
    return calibrate_on_bench(traced, std::move(product), progress);
}

std::filesystem::path calibrate_on_bench(Bench& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress) {
    check_calibrations_folder();  // Before the work.
    const CalibrationSettings settings = settings_of(bench.description(), std::move(product));
    const CalibrationResult found = calibrate_through_ports(bench.ports(), settings, progress);
    progress.update(1.0, "keeping the calibration");
    return keep_calibration(found, settings);
}

void check_calibrations_folder() { make_output_folder(calibrations_folder()); }

std::filesystem::path keep_calibration(const CalibrationResult& made,
                                       const CalibrationSettings& settings) {
    return keep([&](const std::filesystem::path& folder) {
        if (made.projector) {
            write_setup(folder, made.calibration, *made.projector);
        } else {
            write_calibration(folder, made.calibration);
        }
        write_origin(folder, origin_of(made, settings));
        return made.calibration.id;
    });
}

std::filesystem::path keep_nudged(const std::filesystem::path& calibration,
                                  const View& projector,
                                  const Mesh& mesh) {
    return keep([&](const std::filesystem::path& folder) {
        return write_nudged(calibration, folder, projector, bounds_of(mesh));
    });
}

std::filesystem::path keep_reposed(const ReposedCalibration& reposed) {
    return keep([&](const std::filesystem::path& folder) {
        write_reposed(folder, reposed);
        return reposed.calibration.id;
    });
}

std::vector<std::filesystem::path> kept_calibrations() {
    std::vector<std::filesystem::path> kept;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(calibrations_folder(), error), end;
         !error && entry != end;
         entry.increment(error)) {
        const auto& folder = entry->path();
        if (folder.filename().string().starts_with(".")) continue;
        std::error_code unreadable;
        if (std::filesystem::exists(folder / "calibration.json", unreadable)) {
            kept.push_back(folder);
        }
    }
    // Names begin with the date.
    std::sort(kept.begin(), kept.end(), std::greater<>());
    return kept;
}

}  // namespace livery
