#include "calibration/geometry/choose_model.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

namespace {

/// Empty where the model fails for one of them.
std::vector<double> held_out(std::span<const BoardSight> sights,
                             PictureSize camera,
                             PictureSize projector,
                             LensModel model) {
    std::vector<double> errors;
    for (std::size_t out = 0; out < sights.size(); ++out) {
        std::vector<BoardSight> rest(sights.begin(), sights.end());
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(out));
        try {
            const auto error = held_out_px(solve_pair(rest, camera, projector, model), sights[out]);
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
                         PictureSize projector) {
    if (sights.size() < 4)
        throw Refused(fmt::format("{} poses of the board, too few to leave one out", sights.size()),
                      "photograph the board in five or more poses, tilted differently");
    ChosenModel best;
    for (const LensModel model : {LensModel::k1, LensModel::k1_k2, LensModel::all_five}) {
        const std::vector<double> errors = held_out(sights, camera, projector, model);
        if (errors.empty()) continue;
        double squares = 0.0;
        for (const double e : errors) squares += e * e / static_cast<double>(errors.size());
        const double rms = std::sqrt(squares);
        if (!best.held_out_px.empty() && rms >= best.held_out_rms_px) continue;
        best.model = model;
        best.held_out_px = errors;
        best.held_out_rms_px = rms;
    }
    if (best.held_out_px.empty())
        throw Refused("no lens model fits all poses but one and foretells that one",
                      "tilt the board by 20 to 40 degrees, to all four sides");
    best.solution = solve_pair(sights, camera, projector, best.model);
    return best;
}

}  // namespace livery
