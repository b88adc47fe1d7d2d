#include "calibration/geometry/choose_model.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

namespace {

/// Errors of each sight by the solution without it, found from `whole`, that of all. Empty where
/// the model fails for one of them.
std::vector<double> held_out(std::span<const BoardSight> sights,
                             PictureSize camera,
                             PictureSize projector,
                             LensModel model,
                             const PairSolution& whole,
                             const Progress& progress) {
    std::vector<double> errors;
    for (std::size_t out = 0; out < sights.size(); ++out) {
        std::vector<BoardSight> rest(sights.begin(), sights.end());
        PairSolution start = whole;
        const auto place = static_cast<std::ptrdiff_t>(out);
        rest.erase(rest.begin() + place);
        start.camera_from_board.erase(start.camera_from_board.begin() + place);
        try {
            const PairSolution without =
                solve_pair(rest, camera, projector, model, &start, progress);
            const auto error = held_out_px(without, sights[out]);
            if (!error) return {};
            errors.push_back(*error);
        } catch (const Refused&) {
            return {};  // too much distortion for these poses; a smaller model may bear them
        }
    }
    return errors;
}

}  // namespace

ChosenModel choose_model(std::span<const BoardSight> sights,
                         PictureSize camera,
                         PictureSize projector,
                         const Progress& progress) {
    if (sights.size() < 4)
        throw Refused(fmt::format("{} poses of the board, too few to leave one out", sights.size()),
                      "photograph the board in five or more poses, tilted differently");
    ChosenModel best;
    std::optional<PairSolution> smaller;
    for (const LensModel model : {LensModel::k1, LensModel::k1_k2, LensModel::all_five}) {
        PairSolution whole;
        try {
            whole = solve_pair(
                sights, camera, projector, model, smaller ? &*smaller : nullptr, progress);
        } catch (const Refused&) {
            continue;  // as where it fails without one of them
        }
        if (!smaller) smaller = whole;
        const std::vector<double> errors =
            held_out(sights, camera, projector, model, whole, progress);
        if (errors.empty()) continue;
        double squares = 0.0;
        for (const double e : errors) squares += e * e / static_cast<double>(errors.size());
        const double rms = std::sqrt(squares);
        if (!best.held_out_px.empty() && rms >= best.held_out_rms_px) continue;
        best.model = model;
        best.held_out_px = errors;
        best.held_out_rms_px = rms;
        best.solution = whole;
    }
    if (best.held_out_px.empty())
        throw Refused("no lens model fits all poses but one and foretells that one",
                      "tilt the board by 20 to 40 degrees, to all four sides");
    return best;
}

}  // namespace livery
