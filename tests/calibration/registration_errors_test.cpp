// Registration's errors beside those that it claims, over random set-ups.
#include <cmath>
#include <cstdio>
#include <map>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/geometry/solve_pair.h"
#include "calibration/registration/pixel_refinement.h"
#include "calibration/registration/rotation.h"
#include "calibration/support/bench_world.h"
#include "core/random.h"

namespace livery {
namespace {

using testing::Given;
using testing::given_of;
using testing::half_size_world;
using World = testing::BenchWorld;

/// Places that err together over some pixels, as decoded stripes do, and a little by themselves.
void err_together(Sight& sight, std::uint64_t seed) {
    constexpr int kPiece_px = 12;
    constexpr double kTogether_px = 0.15;
    Random random(seed);
    ImageF& map = sight.map.camera_px;
    const int across = map.width / kPiece_px + 1;
    std::vector<glm::dvec2> off;
    for (int k = 0; k < across * (map.height / kPiece_px + 1); ++k) {
        off.push_back(kTogether_px * glm::dvec2(random.normal(), random.normal()));
    }
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            for (int c = 0; c < 2; ++c)
                map.at(x, y, c) += static_cast<float>(
                    off[static_cast<std::size_t>(y / kPiece_px * across + x / kPiece_px)][c]);
}

/// Errors over what is claimed of them, by what they are of.
struct Scores {
    std::map<std::string, double> squares;
    int set_ups = 0, within_two = 0;

    double rms(const std::string& name) const { return std::sqrt(squares.at(name) / set_ups); }
    void print(const char* what) const {
        std::printf("    %s, %d set-ups, rms of the errors over what is claimed:", what, set_ups);
        for (const auto& [name, sum] : squares) std::printf(" %s %.2f,", name.c_str(), rms(name));
        std::printf(" the pose within two sigmas in %d\n", within_two);
    }
};

void add(Scores& scores, const World& world, const Given& given, const PixelRefinement& found) {
    const Rigid3 off = world.projector.view_from_world * inverse(found.projector.view_from_world);
    const glm::dvec3 turn = angle_of(off.rotation) * axis_of(off.rotation);
    constexpr const char* names[] = {"turn x", "turn y", "turn z", "shift x", "shift y", "shift z"};
    bool all = true;
    for (std::size_t c = 0; c < 6; ++c) {
        const int axis = static_cast<int>(c % 3);
        const double error = c < 3 ? turn[axis] : off.translation[axis];
        const double sigmas = error / std::sqrt(found.covariance[7 * c]);
        scores.squares[names[c]] += sigmas * sigmas;
        all = all && std::abs(sigmas) < 2.0;
    }
    const View& lens = given.projector;
    for (const Refined& one : found.lens) {
        double wanted = 0.0;
        if (one.name == "projector focal")
            wanted = std::log(world.projector.focal_px.x / lens.focal_px.x);
        else if (one.name == "projector principal x")
            wanted = world.projector.principal_px.x - lens.principal_px.x;
        else if (one.name == "projector principal y")
            wanted = world.projector.principal_px.y - lens.principal_px.y;
        else
            continue;
        const double sigmas = (one.change - wanted) / one.sigma;
        scores.squares[one.name] += sigmas * sigmas;
    }
    scores.within_two += all;
    ++scores.set_ups;
}

PixelRefinement refined(const World& world, const Given& given, const LensPrior& prior) {
    const Tracer tracer(world.product);
    return refine_on_pixels(world.product,
                            tracer,
                            given.projector,
                            given.sights,
                            world.camera.view_from_world,
                            {},
                            prior);
}

// Less than what is claimed may be: priors and the sandwich are on the safe side.
void expect_errors_as_large_as_said(int set_ups, bool lens_fixed) {
    const World world = half_size_world("default");
    LensPrior prior;
    prior.lens_fixed = lens_fixed;
    Scores scores;
    for (int k = 0; k < set_ups; ++k) {
        Given given = given_of(world, 0.0, static_cast<std::uint64_t>(100 + k));
        err_together(given.sights[0], static_cast<std::uint64_t>(k));
        add(scores, world, given, refined(world, given, prior));
    }
    scores.print(lens_fixed ? "lenses fixed" : "lenses free");
    for (const auto& [name, sum] : scores.squares) EXPECT_LT(scores.rms(name), 1.4) << name;
}
TEST(RegistrationErrors, AreAsLargeAsSaid) { expect_errors_as_large_as_said(12, true); }
TEST(RegistrationErrors, NightlyAreAsLargeAsSaidInAHundredSetUps) {
    expect_errors_as_large_as_said(100, true);
    expect_errors_as_large_as_said(100, false);
}

/// Boards of 9 x 7 corners where the mock-up stands, seen by the world's pair.
std::vector<BoardSight> boards_of(const World& world, double noise_px, std::uint64_t seed) {
    Random random(seed);
    const View& camera = world.camera;
    const Rigid3 pair = world.projector.view_from_world * inverse(camera.view_from_world);
    const glm::dvec3 middle =
        camera.view_from_world *
        (0.5 * glm::dvec3(bounds_of(world.product).low + bounds_of(world.product).high));
    const double square_mm = 0.08 * middle.z * camera.height / camera.focal_px.y;
    std::vector<BoardSight> sights;
    for (int k = 0; k < 8; ++k) {
        const double side = 2.4 * k;  // the golden angle
        const Rigid3 pose{rotation_of({0.45 * std::cos(side), 0.45 * std::sin(side), 0.1 * k}),
                          {0.0, 0.0, 0.0}};
        View seen = camera, lit = world.projector;
        seen.view_from_world = {
            pose.rotation, middle - pose.rotation * glm::dvec3(4 * square_mm, 3 * square_mm, 0)};
        lit.view_from_world = pair * seen.view_from_world;
        BoardSight& sight = sights.emplace_back();
        const auto noise = [&] { return noise_px * glm::dvec2(random.normal(), random.normal()); };
        for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 9; ++x) {
                const glm::dvec3 corner(square_mm * x, square_mm * y, 0.0);
                const auto a = project(seen, corner), b = project(lit, corner);
                if (!a || !b) continue;
                sight.board_mm.emplace_back(corner);
                sight.camera_px.push_back(*a + noise());
                sight.projector_px.push_back(*b + noise());
            }
    }
    return sights;
}

// What boards say of the lenses is weighed as it deserves: the mock-up's photographs, whose pixels
// err together, do not move the focal length by more than boards and they leave open.
void expect_boards_are_believed(int set_ups) {
    const World world = half_size_world("default");
    Scores scores;
    double before = 0.0, after = 0.0;
    for (int k = 0; k < set_ups; ++k) {
        const auto seed = static_cast<std::uint64_t>(1000 + k);
        const PairSolution boards = solve_pair(boards_of(world, 0.15, seed),
                                               {world.camera.width, world.camera.height},
                                               {world.projector.width, world.projector.height});
        Given given = given_of(world, 0.0, seed);
        err_together(given.sights[0], seed);
        given.sights[0].camera = boards.camera;
        given.projector = boards.projector;
        LensPrior prior;
        prior.boards = {boards.information};
        const PixelRefinement found = refined(world, given, prior);
        add(scores, world, given, found);
        before += std::pow(boards.projector.focal_px.x - world.projector.focal_px.x, 2.0) / set_ups;
        after += std::pow(found.projector.focal_px.x - world.projector.focal_px.x, 2.0) / set_ups;
    }
    scores.print("lenses by boards");
    std::printf(
        "    projector's focal length off by %.2f px rms by boards, %.2f with the mock-up\n",
        std::sqrt(before),
        std::sqrt(after));
    for (const auto& [name, sum] : scores.squares) EXPECT_LT(scores.rms(name), 1.4) << name;
    EXPECT_LT(after, 1.2 * before);
}
TEST(RegistrationErrors, OfLensesByBoardsAreAsLargeAsSaid) { expect_boards_are_believed(6); }
TEST(RegistrationErrors, NightlyOfLensesByBoardsInAHundredSetUps) {
    expect_boards_are_believed(100);
}

// Decentred lenses, and data sheets that know nothing of it: the principal point makes up for what
// p1 and p2 do, and says how far it may.
TEST(RegistrationErrors, OfADecentredLensAreAsLargeAsSaid) {
    World world = half_size_world("default");
    world.projector.distortion = {-0.06, 0.02, 0.0012, -0.0015, 0.0};
    world.camera.distortion = {-0.10, 0.04, -0.0008, 0.0010, 0.0};
    LensPrior prior;
    prior.distortion = 0.1;
    prior.tangential = 0.001;
    prior.principal = 0.01;
    Scores scores;
    for (int k = 0; k < 4; ++k) {
        Given given = given_of(world, 0.004, static_cast<std::uint64_t>(300 + k));
        err_together(given.sights[0], static_cast<std::uint64_t>(k));
        given.projector.distortion = given.sights[0].camera.distortion = {};
        const PixelRefinement found = refined(world, given, prior);
        add(scores, world, given, found);
        const testing::DrawnErrors drawn = testing::drawn_errors(world, found.projector);
        std::printf(
            "    drawn %.3f px off in the median, %.3f at 95%%\n", drawn.median_px, drawn.p95_px);
        EXPECT_LT(drawn.p95_px, 0.5);
    }
    scores.print("lenses by data sheets");
    // Four set-ups share one lens: their errors are alike, and up to two sigmas are chance
    for (const auto& [name, sum] : scores.squares) EXPECT_LT(scores.rms(name), 2.0) << name;
}

}  // namespace
}  // namespace livery
