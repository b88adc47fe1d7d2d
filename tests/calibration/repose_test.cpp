// A mock-up that was bumped, found again from two traced photographs: how near, and what is
// refused.
#include "calibration/registration/repose.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "calibration/registration/rotation.h"
#include "calibration/support/bench_world.h"
#include "calibration/support/degree.h"
#include "calibration/support/traced_stripes.h"
#include "core/error.h"
#include "core/statistics.h"
#include "support/thorough.h"

namespace livery {
namespace {

using testing::bench_world;
using testing::drawn_errors;
using testing::DrawnErrors;
using testing::half_size_world;
using testing::kDegree;
using testing::roughened;
using testing::traced_photographs;
using testing::traced_sight;
using World = testing::BenchWorld;

glm::dvec3 middle_of(const Mesh& mesh) {
    const Bounds box = bounds_of(mesh);
    return 0.5 * (box.low + box.high);
}

/// About the mock-up's middle.
Rigid3 bump(const Mesh& mesh, const glm::dvec3& axis_angle, const glm::dvec3& shift_mm) {
    const glm::dmat3 turn = rotation_of(axis_angle);
    const glm::dvec3 middle = middle_of(mesh);
    return {turn, middle + shift_mm - turn * middle};
}

Mesh carried(Mesh mesh, const Rigid3& then_from_now) {
    for (glm::vec3& place : mesh.positions_mm) place = glm::vec3(then_from_now * glm::dvec3(place));
    for (glm::vec3& normal : mesh.normals)
        normal = glm::vec3(then_from_now.rotation * glm::dvec3(normal));
    return mesh;
}

/// Everything of the world but the mock-up, whose triangles come first.
Mesh around_of(const World& world) {
    Mesh mesh = world.all;
    const auto triangles = static_cast<std::ptrdiff_t>(world.product.triangles.size());
    mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + triangles);
    mesh.triangle_part.erase(mesh.triangle_part.begin(), mesh.triangle_part.begin() + triangles);
    return mesh;
}

/// What the geometry's map knows off the mock-up.
ImageF map_around(const World& world, std::uint64_t seed) {
    const Sight sight = traced_sight(world.all, world.projector, world.camera, 0.1, seed);
    const Tracer tracer(world.product);
    ImageF around = sight.map.camera_px;
    for (int y = 0; y < around.height; ++y)
        for (int x = 0; x < around.width; ++x) {
            TraceRay trace;
            const Ray ray = ray_through(world.projector, {x + 0.5, y + 0.5});
            trace.origin = glm::vec3(ray.origin);
            trace.direction = glm::vec3(ray.direction);
            if (tracer.closest(trace).valid() || sight.map.edge.at(x, y))
                around.at(x, y, 0) = around.at(x, y, 1) = std::numeric_limits<float>::quiet_NaN();
        }
    return around;
}

/// How things stand now: the mock-up and the table moved, the devices as given.
struct Now {
    Rigid3 mockup, table;
    std::optional<View> projector, camera;
    bool without_mockup = false;
    double noise = 0.005;
    std::uint64_t seed = 1;
};

ReposeInput photographed(const World& then, const Now& now, bool knows_around = true) {
    ReposeInput input;
    input.projector = then.projector;
    input.camera = then.camera;
    input.code = stripe_code(then.projector.width,
                             then.projector.height,
                             wants_rows(then.projector, then.camera, middle_of(then.product)));
    Mesh world = carried(around_of(then), now.table);
    if (!now.without_mockup) append(world, carried(then.product, now.mockup), "");
    auto both =
        traced_photographs(world,
                           now.projector.value_or(then.projector),
                           now.camera.value_or(then.camera),
                           {stripe_picture(input.code, false), stripe_picture(input.code, true)},
                           now.noise,
                           now.seed);
    input.stripes = std::move(both[0]);
    input.inverse = std::move(both[1]);
    if (knows_around) input.around = map_around(then, now.seed + 100);
    return input;
}

struct Found {
    Repose repose;
    DrawnErrors before, after;
};

Found found_again(const World& then,
                  const Mesh& believed,
                  const Now& now,
                  const char* name,
                  bool knows_around = true,
                  int free_turns = 0) {
    ReposeInput input = photographed(then, now, knows_around);
    input.free_turns = free_turns;
    const Tracer tracer(believed);
    const auto start = std::chrono::steady_clock::now();
    Found found{find_mockup_again(believed, tracer, input), {}, {}};
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    World true_now = then;
    true_now.projector.view_from_world = then.projector.view_from_world * now.mockup;
    found.before = drawn_errors(true_now, then.projector);
    found.after = drawn_errors(true_now, found.repose.projector);
    const Repose& r = found.repose;
    std::printf(
        "    %s (seed %d): drawn %.1f px off before, %.3f / %.3f px after; moved %.2f mm, "
        "%.2f degrees; residual %.3f px, %.0f%% of %zu agree; +- %.3f mm %.3f degrees; around "
        "%zu places, %.0f%% still; %.2f s\n",
        name,
        static_cast<int>(now.seed),
        found.before.median_px,
        found.after.median_px,
        found.after.p95_px,
        r.moved_mm,
        r.turned_rad / kDegree,
        r.median_px,
        100.0 * r.agree_share,
        r.on_product,
        glm::length(r.shift_error_mm),
        glm::length(r.turn_error_rad) / kDegree,
        r.around.places,
        100.0 * r.around.still_share,
        seconds);
    for (const std::string& warning : r.warnings) std::printf("        %s\n", warning.c_str());
    return found;
}

/// A third of a pixel is what the geometry step itself is accepted with half a pixel of, and what
/// a look for drift calls good.
constexpr double kWanted_px = 0.3;

struct Bump {
    const char* name;
    glm::dvec3 turn_degrees, shift_mm;
};
const std::vector<Bump> kBumps{{"hardly moved", {0.0, 0.1, 0.0}, {0.2, 0.0, -0.1}},
                               {"all of it", {-2.0, -3.0, 1.7}, {6.0, 1.0, -8.0}},
                               {"to the left", {0.0, 0.0, 0.0}, {-10.0, 0.0, 0.0}},
                               {"nearer", {0.0, 0.0, 0.0}, {5.0, 5.0, 7.0}},
                               {"farther", {0.0, 0.0, 0.0}, {-5.0, -5.0, -7.0}},
                               {"turned", {0.0, 4.0, 0.0}, {0.0, 0.0, 0.0}},
                               {"tipped", {3.0, 0.0, -2.6}, {0.0, 2.0, 0.0}}};

TEST(Repose, FindsTheCar) {
    const World world = half_size_world("default");
    const Mesh believed = roughened(world.product, 0.03);
    std::uint64_t seed = 1;
    for (const Bump& one : chosen(kBumps, 2)) {
        Now now;
        now.mockup = bump(world.product, kDegree * one.turn_degrees, one.shift_mm);
        now.seed = seed++;
        const Found found = found_again(world, believed, now, one.name);
        EXPECT_LT(found.after.median_px, kWanted_px) << one.name;
        EXPECT_LT(found.after.p95_px, 2.0 * kWanted_px) << one.name;
    }
}

TEST(Repose, NightlyFindsThePlayer) {
    const World world = half_size_world("player");
    const Mesh believed = roughened(world.product, 0.03);
    std::uint64_t seed = 11;
    for (const Bump& one : kBumps) {
        Now now;
        now.mockup = bump(world.product, kDegree * one.turn_degrees, one.shift_mm);
        now.seed = seed++;
        const Found found = found_again(world, believed, now, one.name);
        EXPECT_LT(found.after.median_px, kWanted_px) << one.name;
    }
}

TEST(Repose, FindsTheSphereWhoseTurnStays) {
    const World world = half_size_world("sphere");
    std::uint64_t seed = 21;
    for (const glm::dvec3& shift :
         {glm::dvec3(10.0, 0.0, 0.0), {-3.0, 4.0, -5.0}, {3.0, 4.0, 5.0}}) {
        Now now;
        now.mockup = bump(world.product, {}, shift);
        now.seed = seed++;
        const Found found = found_again(world, world.product, now, "sphere", true, 3);
        EXPECT_LT(found.after.median_px, kWanted_px);
        EXPECT_LT(found.repose.turned_rad, 0.1 * kDegree) << "nothing says that it turned";
        ASSERT_FALSE(found.repose.warnings.empty());
        EXPECT_NE(found.repose.warnings[0].find("turn"), std::string::npos);
    }
}

std::string refusal(const World& world,
                    const Mesh& believed,
                    const Now& now,
                    const char* name,
                    bool knows_around = true) {
    std::string said;
    try {
        found_again(world, believed, now, name, knows_around);
    } catch (const Refused& refused) {
        EXPECT_FALSE(refused.fix().empty());
        said = refused.why();
    }
    std::printf("    %s: %s\n", name, said.c_str());
    return said;
}

TEST(Repose, RefusesWhatItCannotFind) {
    const World world = half_size_world("default");
    Now far;
    far.mockup = bump(world.product, {}, {-60.0, 0.0, 53.0});
    EXPECT_NE(refusal(world, world.product, far, "moved by 80 mm"), "");
    Now gone;
    gone.without_mockup = true;
    EXPECT_NE(refusal(world, world.product, gone, "taken away"), "");
    if (!thorough()) return;
    EXPECT_NE(refusal(world, bench_world("player").product, {}, "another mesh"), "");
    Now dark;
    dark.projector = world.projector;
    dark.projector->view_from_world.translation.z = -1e4;  // it looks the other way
    EXPECT_NE(refusal(world, world.product, dark, "no light"), "");
}

// Somebody who bumps the mock-up bumps the tripod too. What is around tells, whatever the mock-up
// does.
TEST(Repose, NightlyRefusesAPairThatMoved) {
    const World world = half_size_world("default");
    struct Way {
        const char* name;
        glm::dvec2 camera_px;
    };
    for (const Way& way :
         {Way{"camera turned aside", {2.0, 0.0}}, Way{"camera turned down", {0.0, 3.0}}}) {
        Now now;
        now.mockup = bump(world.product, {0.0, 0.02, 0.0}, {3.0, 0.0, -2.0});
        now.camera = world.camera;
        now.camera->principal_px += way.camera_px;
        EXPECT_NE(refusal(world, world.product, now, way.name).find("camera or projector"),
                  std::string::npos);
    }
    Now now;
    now.projector = world.projector;
    now.projector->principal_px += glm::dvec2(2.0, 0.0);
    EXPECT_NE(refusal(world, world.product, now, "projector shifted").find("camera or projector"),
              std::string::npos);
}

// Of a wall and a floor more is seen than of the table.
TEST(Repose, TakesATableThatMovedWithTheMockup) {
    const World world = half_size_world("default");
    Now now;
    now.mockup = now.table = bump(world.product, {0.0, 0.03, 0.0}, {4.0, 0.0, -3.0});
    now.seed = 31;
    const Found found = found_again(world, world.product, now, "table and all");
    EXPECT_LT(found.after.median_px, kWanted_px);
}

TEST(Repose, SaysWhereNothingIsKnownAround) {
    const World world = half_size_world("default");
    Now now;
    now.mockup = bump(world.product, {0.0, 0.03, 0.0}, {4.0, 0.0, -3.0});
    const Found found = found_again(world, world.product, now, "nothing known", false);
    EXPECT_LT(found.after.median_px, kWanted_px);
    ASSERT_FALSE(found.repose.warnings.empty());
    EXPECT_NE(found.repose.warnings.back().find("not looked at"), std::string::npos);
}

// A camera above the projector sees depth in rows.
TEST(Repose, NightlyShowsRowsToACameraAbove) {
    World world = half_size_world("default");
    world.camera = look_at({340.0, 420.0, 300.0}, {0.0, 25.0, 0.0}, 0.24, 864, 576);
    Now now;
    now.mockup = bump(world.product, {0.0, 0.04, 0.02}, {5.0, 0.0, -6.0});
    now.seed = 41;
    EXPECT_TRUE(photographed(world, now).code.rows);
    const Found found = found_again(world, world.product, now, "camera above");
    EXPECT_LT(found.after.median_px, kWanted_px);
    if (!thorough()) return;
    // And one that stands on its side.
    View turned = world.camera;
    turned.view_from_world =
        Rigid3{rotation_of({0.0, 0.0, 0.5 * std::numbers::pi}), {}} * turned.view_from_world;
    std::swap(turned.width, turned.height);
    std::swap(turned.principal_px.x, turned.principal_px.y);
    world.camera = turned;
    const Found aside = found_again(world, world.product, now, "camera above, upright");
    EXPECT_LT(aside.after.median_px, kWanted_px);
}

TEST(Stripes, AreUnlikeAnywhereElse) {
    for (const int width : {320, 640, 1280, 1920}) {
        const StripeCode code = stripe_code(width, width * 10 / 16, false);
        const Image8 picture = stripe_picture(code, false), inverse = stripe_picture(code, true);
        for (int x = 0; x < width; ++x)
            ASSERT_EQ(picture.at(x, 0) + inverse.at(x, 0), 255) << "one of them lights it";
        // Shifted by one period to a dozen, fewer edges meet one of their sign than must agree.
        const double period = 2.0 * code.mean_stripe_px();
        for (double by = period; by < 12.0 * period; by += 1.0) {
            int meet = 0;
            for (std::size_t k = 0; k < code.edges.size(); ++k)
                meet += std::abs(code.nearest_edge(code.edges[k] + by, k % 2 == 0) -
                                 (code.edges[k] + by)) < 0.1 * period;
            ASSERT_LT(meet, 0.6 * static_cast<double>(code.edges.size())) << width << " " << by;
        }
    }
}

}  // namespace
}  // namespace livery
