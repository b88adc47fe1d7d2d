// Boards seen by a known pair of lenses, corner by corner.
#pragma once

#include <random>
#include <stdexcept>
#include <vector>

#include "calibration/geometry/solve_pair.h"
#include "calibration/registration/rotation.h"

namespace livery::testing {

inline constexpr PictureSize kCamera{1280, 1024}, kProjector{1024, 768};

/// Inner corners of a board of 9 x 7, squares of 75 mm.
inline std::vector<glm::dvec2> board_points_mm() {
    std::vector<glm::dvec2> points;
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x) points.emplace_back(75.0 * x, 75.0 * y);
    return points;
}

struct PairTruth {
    View camera, projector;
};

/// The projector's principal point lies below its picture.
inline PairTruth pair_truth() {
    PairTruth t;
    t.camera = {1280, 1024, {2400, 2410}, {652, 505}, {-0.12, 0.1, 0.0005, -0.0004, 0}, {}};
    t.projector = {1024,
                   768,
                   {1900, 1905},
                   {515, 980},
                   {-0.05, 0.02, 0, 0, 0},
                   {rotation_of({0.05, -0.2, 0.02}), {400, 60, 40}}};
    return t;
}

/// The board turned so in each pose, seen by both with Gaussian noise.
inline std::vector<BoardSight> board_sights(const PairTruth& t,
                                            const std::vector<glm::dvec3>& turns,
                                            double noise_px,
                                            std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> unit(0.0, 1.0);
    const auto noise = [&](std::mt19937& from) { return noise_px * unit(from); };
    std::vector<BoardSight> sights;
    for (std::size_t k = 0; k < turns.size(); ++k) {
        const glm::dmat3 r = rotation_of(turns[k]);
        const Rigid3 pose{r,
                          glm::dvec3(20.0 * double(k), 10, 2000 + 80.0 * double(k)) -
                              r * glm::dvec3(300, 225, 0)};
        View camera = t.camera, projector = t.projector;
        camera.view_from_world = pose;
        projector.view_from_world = t.projector.view_from_world * pose;
        BoardSight sight;
        for (const glm::dvec2& p : board_points_mm()) {
            const auto seen = project(camera, {p, 0}), lit = project(projector, {p, 0});
            if (!seen || !lit) throw std::logic_error("a board behind a lens");
            sight.board_mm.push_back(p);
            sight.camera_px.push_back(*seen + glm::dvec2(noise(random), noise(random)));
            sight.projector_px.push_back(*lit + glm::dvec2(noise(random), noise(random)));
        }
        sights.push_back(sight);
    }
    return sights;
}

inline const std::vector<glm::dvec3> kTurns = {{0.5, 0, 0},
                                               {-0.5, 0.1, 0},
                                               {0.1, 0.55, 0.1},
                                               {0, -0.55, 0},
                                               {0.35, 0.35, 0.2},
                                               {-0.3, -0.4, -0.1}};

}  // namespace livery::testing
