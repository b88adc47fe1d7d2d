#include "calibration/geometry/leave_one_out.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

CheckedPair solve_leaving_each_out(std::span<const BoardSight> sights,
                                   PictureSize camera,
                                   PictureSize projector,
                                   const Progress& progress) {
    if (sights.size() < 4)
        throw Refused(fmt::format("{} poses of the board, too few to leave one out", sights.size()),
                      "photograph the board in five or more poses, tilted differently");
    CheckedPair result;
    result.solution = solve_pair(sights, camera, projector, nullptr, progress);
    double squares = 0.0;
    for (std::size_t out = 0; out < sights.size(); ++out) {
        progress.update(static_cast<double>(out) / static_cast<double>(sights.size()),
                        fmt::format("fitting without pose {} of {}", out + 1, sights.size()));
        std::vector<BoardSight> rest(sights.begin(), sights.end());
        PairSolution start = result.solution;
        const auto place = static_cast<std::ptrdiff_t>(out);
        rest.erase(rest.begin() + place);
        start.camera_from_board.erase(start.camera_from_board.begin() + place);
        const PairSolution without = solve_pair(rest, camera, projector, &start, progress);
        const std::optional<double> error = held_out_px(without, sights[out]);
        if (!error)
            throw Refused("the lenses that fit all poses but one cannot show that one",
                          "tilt the board by 20 to 40 degrees, to all four sides");
        result.held_out_px.push_back(*error);
        squares += *error * *error / static_cast<double>(sights.size());
    }
    result.held_out_rms_px = std::sqrt(squares);
    return result;
}

}  // namespace livery
