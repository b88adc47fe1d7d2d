// A calibration ready to correct pictures with, and the projector that it is of; and which
// simulated bench a kept calibration was made on, so that a new session need not make it again.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensation.h"
#include "core/progress.h"
#include "jobs/calibrate/bench_calibration.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/reposed_calibration.h"
#include "scene/colour_calibration.h"
#include "scene/product.h"
#include "scene/view.h"
#include "twin/bench.h"

namespace livery {

/// A hash of all that a calibration on this bench is made from: the bench's file with the files
/// that it names, the mock-up's shape, and how this version calibrates. Throws FileError.
std::string bench_key(const std::string& bench, const Product& product);

/// Notes in a calibration's folder what it was made on. Throws FileError.
void note_bench(const std::filesystem::path& calibration, const std::string& key);

/// The newest of the kept calibrations that was made on this; nothing: there is none.
std::optional<std::filesystem::path> kept_calibration_of(const std::string& key);

/// Immutable and shared: the frame thread, the panels and the bench read the same one.
struct ProjectorSetup {
    View view;  ///< the projector's
    /// Its large planes dropped (status stays); none: uncorrected.
    std::optional<ColourCalibration> calibration;
    std::optional<CompensationTable> table;
    double design_white_y = 0.0;
    std::string why_uncorrected;              ///< empty when there is a table
    std::optional<CalibrationOrigin> origin;  ///< what it was made for, without its photographs
};

/// From a calibration folder (calibration.json and projector.json), for the mock-up with this mesh.
/// Throws FileError (also for a projector of another size than the calibration), Refused when
/// nothing of the mock-up is valid in it.
std::shared_ptr<const ProjectorSetup> load_setup(const std::filesystem::path& folder,
                                                 double design_white_percentile,
                                                 const Mesh& mesh,
                                                 GamutMapping gamut = GamutMapping::strict);
/// No calibration yet: the bench's projector, pictures go out as sRGB.
std::shared_ptr<const ProjectorSetup> uncorrected_setup(const std::string& bench);

/// Calibrates on the simulated bench, keeps the result under `calibrations` in the user's folder
/// (named by date and id; older ones stay) and returns that folder. Throws Refused, Cancelled,
/// FileError; after any of them nothing is left behind.
std::filesystem::path calibrate_on_bench(const std::string& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress);
/// The same on a bench that is already traced with this product as its mock-up.
std::filesystem::path calibrate_on_bench(Bench& bench,
                                         std::shared_ptr<const Product> product,
                                         const Progress& progress);

/// Where the next calibration will be kept can be written. Throws FileError.
void check_calibrations_folder();
/// Keeps a calibration as the newest; where its projector stands must still be said
/// (`add_projector`) if that is not known. Throws FileError.
std::filesystem::path keep_calibration(const CalibrationResult& made,
                                       const CalibrationSettings& settings);

/// The same of one whose mock-up was moved by hand (write_nudged()).
std::filesystem::path keep_nudged(const std::filesystem::path& calibration,
                                  const View& projector,
                                  const Mesh& mesh);

/// The same of one whose mock-up was found again after a bump.
std::filesystem::path keep_reposed(const ReposedCalibration& reposed);

/// Folders of the calibrations kept in the user's folder, newest first.
std::vector<std::filesystem::path> kept_calibrations();

}  // namespace livery
