// Pictures of translucent bodies, against photons and walks.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "appearance/subsurface/subsurface_profile.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/colour.h"
#include "core/statistics.h"
#include "gl/context.h"
#include "radiance/photon_picture.h"
#include "radiance/renderer.h"
#include "radiance/translucent_scenes.h"
#include "reference/path_tracer.h"
#include "support/gl_device.h"
#include "support/kept_truth.h"

namespace livery {
namespace {

struct Differences {
    double median = 0.0, p95 = 0.0;
};
/// CIEDE2000 at the design white, of the pixels that both cover by half or more.
Differences compared(const ImageF& drawn, const ImageF& truth) {
    const glm::dvec3 white = xyz_from_working() * glm::dvec3(1.0);
    std::vector<double> found;
    for (int y = 0; y < truth.height; ++y) {
        for (int x = 0; x < truth.width; ++x) {
            const float *a = drawn.pixel(x, y), *b = truth.pixel(x, y);
            if (a[3] < 0.5f || b[3] < 0.5f) continue;
            const auto lab = [&](const float* p) {
                return lab_from_xyz(xyz_from_working() * glm::dvec3(p[0], p[1], p[2]), white);
            };
            found.push_back(ciede2000(lab(a), lab(b)));
        }
    }
    return {median(found), quantile(found, 0.95)};
}

ImageF drawn_at(const Scene& scene, const View& view, int level) {
    const HeadlessContext context(tested_gl());
    EffectLevels levels = levels_of(Quality::high);
    levels[Effect::subsurface] = level;
    RadianceRenderer renderer(std::make_shared<const FrameGeometry>(scene.product, view),
                              false,
                              ShadingDevice::processor);
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    EXPECT_EQ(find_pass(plan, PassKind::subsurface) != nullptr, level > 0);
    renderer.render(scene, plan);
    return renderer.read_back();
}

constexpr std::size_t kPhotons = 200'000;
/// Of each of two pictures; docs/subsurface.md says of how many it has figures.
std::size_t photons() {
    const char* wanted = std::getenv("LIVERY_SUBSURFACE_PHOTONS");
    return wanted ? static_cast<std::size_t>(std::max(64, std::atoi(wanted))) : kPhotons;
}

/// Sum over columns, along the shadow's edge, of the difference of green light over that of the
/// truth: noise adds little to it.
double off_by(const ImageF& drawn, const ImageF& truth) {
    double apart = 0.0, all = 0.0;
    for (int x = 0; x < truth.width; ++x) {
        double column = 0.0;
        for (int y = 0; y < truth.height; ++y) {
            const auto t = static_cast<double>(truth.at(x, y, 1));
            column += static_cast<double>(drawn.at(x, y, 1)) - t;
            all += t;
        }
        apart += std::abs(column);
    }
    return apart / all;
}

/// What the boundary alone mirrors of the lamp.
ImageF mirrored_alone(Scene scene, const View& view) {
    TranslucentMaterial black = *scene.part_materials[0].medium;
    black.sigma_s_prime_per_mm = glm::dvec3(0.0);
    scene.part_materials[0].medium = std::make_shared<const TranslucentMaterial>(black);
    return drawn_at(scene, view, 0);
}

/// The mean of two independent pictures by photons, and half of their difference, which is what it
/// may err by itself.
struct PhotonTruth {
    ImageF picture;
    Differences floor;
};
PhotonTruth photon_truth(const Scene& scene, const View& view, double around_mm) {
    const ImageF mirrored = mirrored_alone(scene, view);
    const auto by_photons = [&](std::uint64_t seed) {
        if (photons() != kPhotons) return photon_picture(scene, view, around_mm, photons(), seed);
        return testing::kept_picture(
            "photons",
            testing::text_of(scene, view) + fmt::format("{} {} {}", around_mm, photons(), seed),
            [&] { return photon_picture(scene, view, around_mm, photons(), seed); });
    };
    ImageF one = by_photons(1), two = by_photons(2);
    ImageF mean = one;
    for (std::size_t k = 0; k < mean.values.size(); ++k) {
        if (k % 4 == 3) continue;
        one.values[k] += mirrored.values[k];
        two.values[k] += mirrored.values[k];
        mean.values[k] = 0.5f * (one.values[k] + two.values[k]);
    }
    const Differences apart = compared(one, two);
    return {mean, {0.5 * apart.median, 0.5 * apart.p95}};
}

/// With the truth's own noise taken off, as far as that adds up as squares.
double without(double found, double floor) {
    return std::sqrt(std::max(0.0, found * found - floor * floor));
}

struct PictureCase {
    const char* name;
    Scene scene;
    View view;
    double around_mm;
};
std::vector<PictureCase> cases_of(const char* medium) {
    const Material paint = translucent_paint(medium_named(medium));
    return {{"ball of 50 mm",
             shadowed_ball(paint),
             look_at({0, 90, 10}, {0, 24.6, 4}, 0.36, 12, 12),
             25.5},
            {"2 mm plate lit from behind",
             shadowed_plate(paint),
             look_at({0, 200, 1}, {0, 2, 0}, 0.12, 12, 12),
             43.0}};
}

/// The edge of a shadow in pixels of 2 mm.
TEST(SubsurfacePicture, IsNearPhotonsAndAlbedoAloneIsNot) {
    for (const char* name : {"marble", "white pvc", "skim milk"}) {
        for (const PictureCase& one : cases_of(name)) {
            SCOPED_TRACE(one.name);
            const PhotonTruth truth = photon_truth(one.scene, one.view, one.around_mm);
            double off[3] = {};
            for (int level = 0; level < 3; ++level) {
                const ImageF drawn = drawn_at(one.scene, one.view, level);
                const Differences found = compared(drawn, truth.picture);
                off[level] = off_by(drawn, truth.picture);
                std::printf(
                    "    %-10s %-27s %-10s CIEDE2000 median %.2f, 95%% %.2f (truth %.2f, %.2f; "
                    "without it %.2f, %.2f); columns %.1f%% off\n",
                    name,
                    one.name,
                    effect_info(Effect::subsurface).levels[static_cast<std::size_t>(level)].name,
                    found.median,
                    found.p95,
                    truth.floor.median,
                    truth.floor.p95,
                    without(found.median, truth.floor.median),
                    without(found.p95, truth.floor.p95),
                    100.0 * off[level]);
            }
            // Noise that is left in the columns' sums is 1%
            EXPECT_LT(off[1], 0.7 * off[0]) << name;
            EXPECT_LT(off[2], 0.7 * off[0]) << name;
            EXPECT_LT(off[2], 0.08) << name;
        }
    }
}

/// What a half plane of even light sends out at such a distance from its edge, over what it does
/// in its midst.
double beside_an_edge(const SubsurfaceProfile& profile, double distance_mm) {
    constexpr double kFarthest_mm = 60.0, kFiner = 1.01;
    const double inner = std::max(distance_mm, 1e-4);
    double sum = 0.0;
    for (double r = inner; r < kFarthest_mm; r *= kFiner) {
        const double middle = r * std::sqrt(kFiner);
        sum += profile.reflectance(middle) * 2.0 * middle * std::acos(distance_mm / middle) * r *
               (kFiner - 1.0);
    }
    return sum / profile.totals.reflectance;
}

/// Wherever the edge of a shadow lies between nodes.
TEST(SubsurfacePicture, NightlyTheEdgeOfAShadowIsTheIntegralOfTheProfile) {
    const TranslucentMaterial medium = medium_named("white pvc");
    const SubsurfaceProfile profile =
        subsurface_profile(SubsurfaceModel::scaled_beam_diffusion, medium_of(medium, 1));
    const View view = look_at({0, 100, 1}, {0, 30, 0}, 0.3425, 12, 12);
    const double pixel_mm = 140.0 * std::tan(0.5 * 0.3425) / 12.0;
    for (const float edge_mm : {-0.6f, 0.0f, 0.6f, 1.2f}) {
        Mesh mesh = plate_mesh(30.0f);
        const std::size_t own = mesh.triangles.size();
        add_box(mesh, {-60.0f, 110.0f, -60.0f}, {edge_mm, 130.0f, 60.0f});
        mesh.parts.resize(2);
        mesh.triangle_part.resize(own);
        mesh.triangle_part.resize(mesh.triangles.size(), 1);
        Scene scene = scene_of(std::move(mesh), translucent_paint(medium));
        scene.part_materials[1] = Material{};
        scene.part_materials[1].diffuse = glm::dvec3(0.0);
        scene.lights = {light_from({0.0, 1.0, 0.0}, 0.001)};
        scene.eye_in_world_mm = {60.0, 250.0, 500.0};
        for (int level = 1; level < 3; ++level) {
            const ImageF drawn = drawn_at(scene, view, level);
            const double lit = static_cast<double>(drawn_at(scene, view, 0).at(11, 5, 1));
            // Up to three nodes into the shadow; the mean over the pixel
            for (int x = 5; x > 2; --x) {
                double wanted = 0.0;
                constexpr int kPlaces = 40;
                for (int k = 0; k < kPlaces; ++k) {
                    const double at_mm = (x - 6 + (k + 0.5) / kPlaces) * pixel_mm;
                    const double into = static_cast<double>(edge_mm) - at_mm;
                    wanted += (into > 0.0 ? beside_an_edge(profile, into)
                                          : 1.0 - beside_an_edge(profile, -into)) /
                              kPlaces;
                }
                const double found = static_cast<double>(drawn.at(x, 5, 1)) / lit;
                std::printf("    edge at %4.1f mm, level %d, pixel %d: %.4f, integral %.4f\n",
                            static_cast<double>(edge_mm),
                            level,
                            x,
                            found,
                            wanted);
                // A fourth of a node's side off is 10% at `transport`, 18% at `gather`
                EXPECT_NEAR(found / wanted, 1.0, level == 1 ? 0.25 : 0.15);
            }
        }
    }
}

/// A sheet that is modelled by one side looks as the plate that it stands for, from both sides, by
/// nodes and by walks.
TEST(SubsurfacePicture, OfAnOpenSheetIsThatOfAPlateAsThick) {
    Material paint = translucent_paint(medium_named("marble"));
    const Scene plate = shadowed_plate(paint);
    TranslucentMaterial two_mm = *paint.medium;
    two_mm.thickness_mm = 2.0;
    paint.medium = std::make_shared<const TranslucentMaterial>(two_mm);
    Scene sheet = shadowed_plate(paint, sheet_mesh(2.0f));
    const View lit_through = look_at({0, 200, 1}, {0, 2, 0}, 0.12, 12, 12);
    for (int level = 1; level < 3; ++level) {
        const Differences apart =
            compared(drawn_at(sheet, lit_through, level), drawn_at(plate, lit_through, level));
        std::printf("    sheet and plate, level %d: CIEDE2000 median %.2f, 95%% %.2f\n",
                    level,
                    apart.median,
                    apart.p95);
        // Nodes lie elsewhere: at the shadow's edge each picture is some 1.6 from photons
        EXPECT_LT(apart.median, 0.5);
        EXPECT_LT(apart.p95, 2.3);
    }
    ReferenceOptions options;
    options.samples_per_pixel = 1024;
    const ImageF of_plate = testing::kept_truth("walks", plate, lit_through, options);
    const ImageF of_sheet = testing::kept_truth("walks", sheet, lit_through, options);
    // A column has 12,000 walks
    EXPECT_LT(off_by(of_sheet, of_plate), 0.05);

    // From its other side, at which the lamp shines
    sheet.eye_in_world_mm = {0.0, -400.0, 100.0};
    sheet.lights = {light_from({0.0, 1.0, 0.0}, 0.05)};
    const View from_below = look_at({0, -9, 1}, {0, 2, 0}, 1.2, 12, 12);
    const auto mean = [](const ImageF& picture) {
        double sum = 0.0, covered = 0.0;
        for (int y = 0; y < picture.height; ++y) {
            for (int x = 0; x < picture.width; ++x) {
                const float* p = picture.pixel(x, y);
                if (p[3] < 0.5f) continue;
                sum += static_cast<double>(p[1]);
                covered += 1.0;
            }
        }
        return sum / covered;
    };
    const double drawn = mean(drawn_at(sheet, from_below, 1));
    const double walked = mean(testing::kept_truth("walks", sheet, from_below, options));
    std::printf("    lit from above, seen from below: %.4f drawn, %.4f walked\n", drawn, walked);
    EXPECT_GT(walked, 0.05);
    EXPECT_NEAR(drawn / walked, 1.0, 0.05);
}

/// Photons from the lamp and walks from the eye share the medium and the boundary, and nothing of
/// how a picture comes of them.
TEST(SubsurfacePicture, PhotonsShowWhatWalksFromTheEyeDo) {
    const PictureCase one = cases_of("marble").front();
    const PhotonTruth truth = photon_truth(one.scene, one.view, one.around_mm);
    ReferenceOptions options;
    options.samples_per_pixel = 64;
    const ImageF walked = testing::kept_truth("walks", one.scene, one.view, options);
    for (int c = 0; c < 3; ++c) {
        double by_photons = 0.0, by_walks = 0.0;
        for (int y = 0; y < walked.height; ++y) {
            for (int x = 0; x < walked.width; ++x) {
                by_photons += static_cast<double>(truth.picture.at(x, y, c));
                by_walks += static_cast<double>(walked.at(x, y, c));
            }
        }
        // 9000 walks, a quarter of which come back with light
        EXPECT_NEAR(by_photons / by_walks, 1.0, 0.03) << c;
    }
}

/// How much light comes back from a ball that is a mean free path across, and from one that is ten.
TEST(SubsurfacePicture, ShowsAsMuchOfClearBallsAsWalks) {
    const View view = look_at({0, 90, 10}, {0, 0, 0}, 0.9, 24, 24);
    for (const char* name : {"bleach", "gatorade", "white grapefruit juice"}) {
        Scene scene = shadowed_ball(translucent_paint(medium_named(name)));
        scene.lights = {light_from({0.3, 1.0, 0.15}, 0.01)};
        const ImageF mirrored = mirrored_alone(scene, view);
        ReferenceOptions options;
        options.samples_per_pixel = 256;
        const ImageF walked = testing::kept_truth("walks", scene, view, options);
        const ImageF drawn = drawn_at(scene, view, 1);
        double by_walks = 0.0, by_nodes = 0.0;
        for (std::size_t k = 0; k < drawn.values.size(); ++k) {
            if (k % 4 == 3) continue;
            by_walks += static_cast<double>(walked.values[k] - mirrored.values[k]);
            by_nodes += static_cast<double>(drawn.values[k] - mirrored.values[k]);
        }
        std::printf("    %-24s %.3f of what walks find\n", name, by_nodes / by_walks);
        // Where it leaves is diffusion's guess; ten times as much is what this is about
        EXPECT_NEAR(by_nodes / by_walks, 1.0, 0.35) << name;
    }
}

/// A ball of marble with a cavity, its wall 2 mm thick: through the lit half light gets into the
/// cavity, and out of it through the other half.
TEST(SubsurfacePicture, OfAHollowBallIsLitFromWithin) {
    Mesh mesh = make_sphere({0, 0, 0}, 25.0, 64, "ball");
    Mesh cavity = make_sphere({0, 0, 0}, 23.0, 64, "ball");
    for (glm::uvec3& corners : cavity.triangles) std::swap(corners.y, corners.z);
    for (glm::vec3& normal : cavity.normals) normal = -normal;
    append(mesh, cavity, "");
    mesh.parts.resize(1);
    std::fill(mesh.triangle_part.begin(), mesh.triangle_part.end(), std::uint16_t{0});
    Scene scene = scene_of(std::move(mesh), translucent_paint(medium_named("marble")));
    scene.lights = {light_from({0.0, 1.0, 0.0}, 0.01)};
    scene.eye_in_world_mm = {300.0, 0.0, 0.0};
    const View view = look_at({120, 0, 0}, {0, 0, 0}, 0.42, 16, 16);
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    const ImageF walked = testing::kept_truth("walks", scene, view, options);
    const auto sums = [](const ImageF& picture) {
        glm::dvec2 sum(0.0);  // of the lit half and of the other
        for (int y = 0; y < picture.height; ++y) {
            for (int x = 0; x < picture.width; ++x) {
                const float* p = picture.pixel(x, y);
                sum[2 * y < picture.height ? 0 : 1] += static_cast<double>(p[3] * p[1]);
            }
        }
        return sum;
    };
    const glm::dvec2 truth = sums(walked);
    for (int level = 1; level < 3; ++level) {
        const glm::dvec2 found = sums(drawn_at(scene, view, level)) / truth;
        std::printf(
            "    hollow ball, level %d: %.3f of what walks find where it is lit, %.3f from "
            "within\n",
            level,
            found[0],
            found[1]);
        // Half of the picture is 20,000 walks; what comes twice through the wall errs twice
        EXPECT_NEAR(found[0], 1.0, 0.05);
        EXPECT_NEAR(found[1], 1.0, 0.1);
    }
    EXPECT_GT(truth[1], 0.1 * truth[0]);
}

}  // namespace
}  // namespace livery
