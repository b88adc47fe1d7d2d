// Maps of the light all around: gathered, merged, filled, and what is said of them.

#include "calibration/environment/radiance_map.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "calibration/environment/light_picture.h"
#include "calibration/environment/map_figures.h"
#include "calibration/environment/mirror_ball.h"
#include "calibration/support/degree.h"
#include "core/worst_error.h"
#include "scene/look.h"
#include "support/message_of.h"

namespace livery {
namespace {

using testing::kDegree;

RadianceMap empty(int width) {
    return {ImageF(width, width / 2, 3),
            ImageF(width, width / 2, 1),
            ImageF(width, width / 2, 1),
            ImageF(width, width / 2, 1)};
}

/// A map wholly seen by pixels of one degree.
template <typename Radiance>
RadianceMap seen_map(int width, const Radiance& radiance) {
    RadianceMap map = empty(width);
    for (int y = 0; y < width / 2; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 value = radiance(texel_direction(map.radiance, x, y));
            for (int c = 0; c < 3; ++c) map.radiance.at(x, y, c) = static_cast<float>(value[c]);
            map.seen.at(x, y) = 1.0f;
            map.widest_rad.at(x, y) = static_cast<float>(kDegree);
        }
    }
    return map;
}

TEST(RadianceMap, TexelsCoverAllDirectionsOnce) {
    const ImageF map(64, 32, 1);
    double sum = 0.0;
    glm::dvec3 middle(0.0);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            sum += texel_sr(map, y);
            middle += texel_sr(map, y) * texel_direction(map, x, y);
        }
    }
    EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 1e-12);
    EXPECT_LT(glm::length(middle), 1e-10);
}

TEST(RadianceMap, EvenLightIsEvenWithoutHolesHoweverFineTheMap) {
    const View view = look_at({0.0, 0.0, 500.0}, {0.0, 0.0, 0.0}, 0.2, 90, 90);
    const MirrorBall ball{{{0.0, 0.0, 0.0}, 60.0}, glm::dvec3(0.5, 0.6, 0.8), true};
    LightPicture picture{ImageF(90, 90, 3, 0.5f), Image8(90, 90, 1), Image8(90, 90, 1)};
    // The reflectance grows toward the rim; light that is the same all around takes its pattern.
    const SeeDirection see = seen_in_ball(view, ball);
    for (const int width : {16, 128, 512}) {
        const RadianceMap map = gather(picture, see, false, width);
        for (int y = 0; y < width / 2; ++y) {
            for (int x = 0; x < width; ++x) {
                const auto at = see(texel_direction(map.radiance, x, y));
                if (!at) continue;
                ASSERT_GT(map.seen.at(x, y), 0.0f);
                if (map.seen.at(x, y) < 1.0f || width < 100) continue;
                // Over a texel the share that passes changes a little.
                ASSERT_NEAR(map.radiance.at(x, y, 1) / (0.5 / at->passed.y), 1.0, 0.02);
            }
        }
    }
}

TEST(RadianceMap, NoPixelIsSkippedWhereTexelsAreWide) {
    // A single bright pixel of a panorama, in a map 16 times as coarse: its light is kept.
    const int width = 512, height = 256;
    const SeeDirection see = seen_in_panorama(glm::dmat3(1.0), width, height);
    for (const glm::ivec2 pixel : {glm::ivec2(256, 128), glm::ivec2(0, 60), glm::ivec2(77, 200)}) {
        LightPicture picture{
            ImageF(width, height, 3), Image8(width, height, 1), Image8(width, height, 1)};
        picture.light.at(pixel.x, pixel.y, 1) = 1000.0f;
        const RadianceMap map = gather(picture, see, true, 32);
        double light = 0.0;
        glm::dvec3 middle(0.0);
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 32; ++x) {
                const double here = texel_sr(map.radiance, y) * map.radiance.at(x, y, 1);
                light += here;
                middle += here * texel_direction(map.radiance, x, y);
            }
        }
        const ImageF fine(width, height, 1);
        EXPECT_NEAR(light / (1000.0 * texel_sr(fine, pixel.y)), 1.0, 0.05);
        EXPECT_GT(glm::dot(glm::normalize(middle), texel_direction(fine, pixel.x, pixel.y)),
                  std::cos(12.0 * kDegree));
    }
}

TEST(RadianceMap, TheFinerViewCountsMoreAndTheUnclippedAlone) {
    const auto even = [](double value, double pixel_rad, float clipped) {
        RadianceMap map = seen_map(8, [&](const glm::dvec3&) { return glm::dvec3(value); });
        std::fill(map.widest_rad.values.begin(),
                  map.widest_rad.values.end(),
                  static_cast<float>(pixel_rad));
        std::fill(map.saturated.values.begin(), map.saturated.values.end(), clipped);
        return map;
    };
    std::vector<RadianceMap> maps{even(1.0, 0.01, 0.0f), even(2.0, 0.03, 0.0f)};
    EXPECT_NEAR(merge(maps).radiance.at(3, 2, 0), (9.0 * 1.0 + 2.0) / 10.0, 1e-6);
    EXPECT_NEAR(merge(maps).widest_rad.at(3, 2), 0.01, 1e-8);
    maps[0] = even(1.0, 0.01, 1.0f);
    EXPECT_NEAR(merge(maps).radiance.at(3, 2, 0), 2.0, 1e-6);
    EXPECT_EQ(merge(maps).saturated.at(3, 2), 0.0f);
    maps[1] = even(2.0, 0.03, 0.5f);
    EXPECT_GT(merge(maps).saturated.at(3, 2), 0.5f);
    // What one does not see is the other's.
    maps[0].seen.at(3, 2) = 0.0f;
    EXPECT_NEAR(merge(maps).radiance.at(3, 2, 0), 2.0, 1e-6);
    maps.push_back(empty(16));
    EXPECT_THROW(merge(maps), std::invalid_argument);
    EXPECT_THROW(merge({}), std::invalid_argument);
}

/// Takes away what lies within an angle of a direction.
void hide(const glm::dvec3& middle, double angle, RadianceMap& map) {
    for (int y = 0; y < map.seen.height; ++y) {
        for (int x = 0; x < map.seen.width; ++x) {
            if (glm::dot(texel_direction(map.seen, x, y), middle) < std::cos(angle)) continue;
            map.seen.at(x, y) = 0.0f;
            map.widest_rad.at(x, y) = 0.0f;
            for (int c = 0; c < 3; ++c) map.radiance.at(x, y, c) = 0.0f;
        }
    }
}

TEST(UnseenDirections, AreFilledHarmonically) {
    // Stereographic projection from the opposite point makes of harmonic functions of the plane
    // those of the sphere: x, y and x y.
    for (const glm::dvec3 middle : {glm::dvec3(0, 1, 0),
                                    glm::dvec3(0, -1, 0),
                                    glm::normalize(glm::dvec3(0.3, 0.2, 1.0)),
                                    glm::normalize(glm::dvec3(-0.5, 0.9, -0.3))}) {
        const glm::dvec3 side = glm::normalize(glm::cross(middle, glm::dvec3(0.2, 0.1, 0.9)));
        const glm::dvec3 up = glm::cross(side, middle);
        const auto truth = [&](const glm::dvec3& d) {
            const double scale = 1.0 / (1.02 + glm::dot(d, middle));
            const double x = glm::dot(d, side) * scale, y = glm::dot(d, up) * scale;
            return glm::dvec3(2.0 + x, 2.0 + y, 2.0 + x * y);
        };
        const auto exact = [&](const glm::dvec3& d) {
            const double scale = 1.0 / (1.0 + glm::dot(d, middle));
            const double x = glm::dot(d, side) * scale, y = glm::dot(d, up) * scale;
            return glm::dvec3(2.0 + x, 2.0 + y, 2.0 + x * y);
        };
        RadianceMap map = seen_map(128, [&](const glm::dvec3& d) {
            return glm::dot(d, middle) > 0.0 ? exact(d) : truth(d);
        });
        const double angle = 25.0 * kDegree;
        hide(middle, angle, map);
        const double share = fill_unseen(map);
        EXPECT_NEAR(share, 0.5 * (1.0 - std::cos(angle)), 0.003);
        double worst = 0.0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 128; ++x) {
                const glm::dvec3 d = texel_direction(map.seen, x, y);
                if (glm::dot(d, middle) < std::cos(angle)) continue;
                for (int c = 0; c < 3; ++c) {
                    worst = worse_of(worst, std::abs(map.radiance.at(x, y, c) - exact(d)[c]));
                }
            }
        }
        // The finite volumes' own error: x and y reach 0.22 at the hole's edge.
        EXPECT_LT(worst, 0.01);
    }
}

TEST(UnseenDirections, StayBetweenTheirSurroundings) {
    RadianceMap map = seen_map(64, [](const glm::dvec3& d) {
        return glm::dvec3(d.x > 0.0 ? 10.0 : 0.0, 1.0, std::max(d.y, 0.0));
    });
    hide({0.0, 0.0, 1.0}, 60.0 * kDegree, map);
    hide({0.0, -1.0, 0.0}, 20.0 * kDegree, map);
    fill_unseen(map);
    for (std::size_t k = 0; k < map.seen.values.size(); ++k) {
        ASSERT_GE(map.radiance.values[3 * k], 0.0f);
        ASSERT_LE(map.radiance.values[3 * k], 10.0f);
        ASSERT_NEAR(map.radiance.values[3 * k + 1], 1.0f, 1e-4f);
    }
    // A lamp at the edge ends there.
    const auto lamp = [](const glm::dvec3& d) {
        return glm::dvec3(glm::dot(d, glm::normalize(glm::dvec3(0.3, 0.0, 1.0))) > 0.99 ? 100.0
                                                                                        : 1.0);
    };
    RadianceMap lit = seen_map(64, lamp);
    hide({0.0, 0.0, 1.0}, 17.0 * kDegree, lit);
    fill_unseen(lit);
    EXPECT_LE(lit.radiance.at(0, 16, 0), 3.0f);
    EXPECT_GE(lit.radiance.at(0, 16, 0), 1.0f);
    RadianceMap whole = seen_map(16, [](const glm::dvec3&) { return glm::dvec3(1.0); });
    EXPECT_EQ(fill_unseen(whole), 0.0);
    RadianceMap nothing = empty(16);
    EXPECT_NE(message_of([&] { fill_unseen(nothing); }).find("no direction's light"),
              std::string::npos);
}

TEST(MapFigures, WhiteIsAsBrightAsEvenLight) {
    const RadianceMap even = seen_map(256, [](const glm::dvec3&) { return glm::dvec3(0.7); });
    EXPECT_NEAR(brightest_white(even.radiance), 0.7, 0.002);
    EXPECT_NEAR(dynamic_range_stops(even), 0.0, 1e-6);
    // Light from one side: a hemisphere of radiance 2 is 2 on what faces it.
    const RadianceMap half =
        seen_map(256, [](const glm::dvec3& d) { return glm::dvec3(d.x > 0.0 ? 2.0 : 0.5); });
    EXPECT_NEAR(brightest_white(half.radiance), 2.0, 0.02);
    EXPECT_NEAR(dynamic_range_stops(half), 2.0, 1e-6);
}

TEST(MapFigures, ClippedLampsAreCountedAndSaidHowMuchTheyGive) {
    // Two lamps of 6 degrees, one across the map's seam, in even light of 1.
    const glm::dvec3 seam = glm::normalize(glm::dvec3(0.0, 0.3, 1.0));
    const glm::dvec3 other = glm::normalize(glm::dvec3(1.0, -0.4, -0.5));
    const double near = std::cos(6.0 * kDegree);
    RadianceMap map = seen_map(512, [&](const glm::dvec3& d) {
        return glm::dvec3(glm::dot(d, seam) > near    ? 101.0
                          : glm::dot(d, other) > near ? 41.0
                                                      : 1.0);
    });
    for (std::size_t k = 0; k < map.seen.values.size(); ++k) {
        if (map.radiance.values[3 * k] > 2.0f) map.saturated.values[k] = 1.0f;
    }
    const auto lamps = clipped_lamps(map);
    ASSERT_EQ(lamps.size(), 2u);
    EXPECT_GT(glm::dot(lamps[0].direction, seam), std::cos(0.3 * kDegree));
    EXPECT_GT(glm::dot(lamps[1].direction, other), std::cos(0.3 * kDegree));
    const double sr = 2.0 * std::numbers::pi * (1.0 - near);
    EXPECT_NEAR(lamps[0].solid_angle_sr / sr, 1.0, 0.02);
    EXPECT_NEAR(lamps[0].luminance, 101.0, 0.01);
    // On a surface that faces the first: its own, even light's pi, and the other's aslant, if at
    // all.
    const double facing = sr * (1.0 + near) / 2.0;
    const double all = 101.0 * facing + std::numbers::pi - facing +
                       40.0 * facing * std::max(glm::dot(seam, other), 0.0);
    EXPECT_NEAR(lamps[0].irradiance_share, 101.0 * facing / all, 0.01);
    EXPECT_TRUE(
        clipped_lamps(seen_map(16, [](const glm::dvec3&) { return glm::dvec3(1.0); })).empty());
}

TEST(MapFigures, CoarsePixelsAreToldApart) {
    RadianceMap map = seen_map(64, [](const glm::dvec3&) { return glm::dvec3(1.0); });
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 64; ++x) map.widest_rad.at(x, y) = static_cast<float>(3.0 * kDegree);
    }
    hide({0.0, -1.0, 0.0}, 60.0 * kDegree, map);
    const Coverage coverage = coverage_of(map);
    EXPECT_NEAR(coverage.coarse, 0.5, 1e-9);
    EXPECT_NEAR(coverage.covered, 0.25, 0.03);
}

TEST(Panorama, LooksWhereItWasTurned) {
    // To the left is counter-clockwise seen from above: the middle looks from -z toward -x.
    const auto middle = [](double yaw, double pitch, double roll) {
        return world_from_panorama(yaw * kDegree, pitch * kDegree, roll * kDegree) *
               glm::dvec3(0.0, 0.0, -1.0);
    };
    EXPECT_LT(glm::distance(middle(90, 0, 0), glm::dvec3(-1, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(middle(0, 90, 0), glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_LT(glm::distance(middle(0, 0, 33), glm::dvec3(0, 0, -1)), 1e-12);
    // One that leans to its right has its top to the right.
    const glm::dvec3 top = world_from_panorama(0.0, 0.0, 90.0 * kDegree) * glm::dvec3(0, 1, 0);
    EXPECT_LT(glm::distance(top, glm::dvec3(1, 0, 0)), 1e-12);
    // Turned by a quarter: what lies at -x is in the panorama's middle.
    const SeeDirection see = seen_in_panorama(world_from_panorama(90.0 * kDegree, 0, 0), 400, 200);
    EXPECT_LT(glm::distance(see({-1.0, 0.0, 0.0})->pixel, glm::dvec2(200.0, 100.0)), 1e-9);
}

TEST(Panorama, MarksTellHowItWasTurned) {
    const glm::dmat3 turn = world_from_panorama(0.7, -0.2, 0.4);
    const SeeDirection see = seen_in_panorama(turn, 2048, 1024);
    const auto mark = [&](const glm::dvec3& direction, double off_px) {
        return PanoramaMark{see(glm::normalize(direction))->pixel + glm::dvec2(off_px, 0.0),
                            direction};
    };
    const PanoramaMark a = mark({1.0, 0.2, -3.0}, 0.0), b = mark({-4.0, 1.0, 0.5}, 0.0);
    const PanoramaOrientation found = orientation_of(a, b, 2048, 1024);
    for (int c = 0; c < 3; ++c) {
        EXPECT_LT(glm::distance(found.world_from_panorama[c], turn[c]), 1e-9);
    }
    EXPECT_LT(found.residual_rad, 1e-9);
    EXPECT_NEAR(orientation_of(a, mark({-4.0, 1.0, 0.5}, 5.0), 2048, 1024).residual_rad,
                5.0 * 2.0 * std::numbers::pi / 2048,
                0.01);
    EXPECT_THROW(orientation_of(a, mark({1.0, 0.2, -2.9}, 0.0), 2048, 1024), Refused);
    EXPECT_THROW(orientation_of(a, {b.pixel, {1.0, 0.5, -2.0}}, 2048, 1024), Refused);
}

TEST(Panorama, KeepsItsPixelsInAMapOfItsSize) {
    LightPicture picture{ImageF(128, 64, 3), Image8(128, 64, 1), Image8(128, 64, 1)};
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 128; ++x) {
            const double u = 2.0 * std::numbers::pi * (x + 0.5) / 128;
            picture.light.at(x, y, 0) = static_cast<float>(2.0 + std::sin(3.0 * u));
            picture.light.at(x, y, 1) = static_cast<float>(1.0 + y);
        }
    }
    picture.left_out.at(5, 40) = 1;
    picture.saturated.at(90, 10) = 1;
    const RadianceMap map = gather(picture, seen_in_panorama(glm::dmat3(1.0), 128, 64), true, 128);
    // Toward the poles the middle of a row's solid angle moves away from them.
    for (int y = 2; y < 62; ++y) {
        for (int x = 0; x < 128; ++x) {
            if (std::abs(x - 5) <= 1 && std::abs(y - 40) <= 1) continue;
            ASSERT_EQ(map.seen.at(x, y), 1.0f);
            ASSERT_NEAR(map.radiance.at(x, y, 0), picture.light.at(x, y, 0), 0.01);
            ASSERT_NEAR(map.radiance.at(x, y, 1), 1.0 + y, 0.05);
        }
    }
    EXPECT_EQ(map.seen.at(5, 40), 0.0f);
    EXPECT_GT(map.saturated.at(90, 10), 0.5f);
    EXPECT_EQ(map.saturated.at(93, 10), 0.0f);
}

}  // namespace
}  // namespace livery
