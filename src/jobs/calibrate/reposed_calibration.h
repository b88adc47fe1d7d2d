// A calibration whose mock-up stands elsewhere now, made to fit again: with two photographs of
// stripes, or moved by hand.
#pragma once

#include <filesystem>
#include <string>

#include "calibration/registration/repose.h"
#include "core/bench_ports.h"
#include "core/grade.h"
#include "core/progress.h"
#include "jobs/calibrate/calibration_folder.h"
#include "mesh/mesh.h"
#include "scene/colour_calibration.h"
#include "scene/product.h"
#include "scene/view.h"

namespace livery {

struct ReposedCalibration {
    Repose found;
    ColourCalibration calibration;  ///< carry_colours() of the one before
    CalibrationOrigin origin;       ///< its room is that of now, and it names the one before
};

/// What is to be shown for a calibration. Throws Refused where its origin does not say where
/// everything stood, or the product's mesh is another.
StripeCode stripes_for(const CalibrationOrigin& origin, const Product& product);

/// Shows the stripes and their inverse over the whole picture (roles `repose`, `repose-inverse`),
/// photographs them at the exposure of the calibration's end, finds the mock-up, carries the
/// colours, and shows white and black on the mock-up alone: what a look for drift compares with.
/// Photographs that were taken before (`turn_to`) are taken as they are, and the result has none of
/// its end. `origin` with its photographs. Throws as stripes_for(), find_mockup_again(),
/// photograph_ends() and the ports.
ReposedCalibration repose_through_ports(const BenchPorts& ports,
                                        const ColourCalibration& calibration,
                                        const CalibrationOrigin& origin,
                                        const Product& product,
                                        const Progress& progress = {});

/// write_setup() and write_origin(). Throws as these.
void write_reposed(const std::filesystem::path& folder, const ReposedCalibration& reposed);

/// What was found, in figures for people.
std::vector<GradedFigure> grade_figures(const Repose& found);

/// Writes the calibration in the folder `from` for this view of its projector to the folder `to`,
/// which is replaced whole or not: a version of its own that says by how much it was moved. Colours
/// stay with their projector pixels, the camera with the projector. `mockup`: bounds of its mesh.
/// Returns its id. Throws FileError, std::invalid_argument for another lens or size than the
/// calibration's.
std::string write_nudged(const std::filesystem::path& from,
                         const std::filesystem::path& to,
                         const View& projector,
                         const Bounds& mockup);

}  // namespace livery
