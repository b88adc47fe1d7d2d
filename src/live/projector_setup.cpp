#include "live/projector_setup.h"

#include <algorithm>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/error.h"
#include "core/log.h"
#include "core/paths.h"
#include "core/replace_folder.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/calibration_origin.h"
#include "jobs/calibrate/nudged_calibration.h"
#include "live/setup_cache.h"
#include "scene/mockup_mask.h"
#include "twin/description.h"

namespace livery {

namespace {

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
    const BenchCalibrationRequest request = request_of(bench.description(), std::move(product));
    const BenchCalibration found = calibrate_through_ports(bench.ports(), request, progress);
    progress.update(1.0, "keeping the calibration");
    return keep_calibration(found, request);
}

void check_calibrations_folder() { make_output_folder(calibrations_folder()); }

std::filesystem::path keep_calibration(const BenchCalibration& made,
                                       const BenchCalibrationRequest& request) {
    return keep([&](const std::filesystem::path& folder) {
        if (made.projector) {
            write_setup(folder, made.calibration, *made.projector);
        } else {
            write_calibration(folder, made.calibration);
        }
        write_origin(folder, origin_of(made, request));
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
