// Spectral truth: folded factors against sums over all bands, light sources, surfaces, bounces.
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/random.h"
#include "small_bench.h"
#include "tracing/tracer.h"
#include "twin/projector_light.h"
#include "twin/received.h"

namespace livery {
namespace {

using namespace livery::testing;

double nm_of(std::size_t band) {
    return kSpectrumFirst_nm + kSpectrumStep_nm * static_cast<double>(band);
}

/// Strongly coloured: a narrow band and a floor.
Spectrum band(double centre_nm, double width_nm) {
    Spectrum spectrum{};
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
        const double z = (nm_of(k) - centre_nm) / width_nm;
        spectrum[k] = 0.02 + 0.9 * std::exp(-0.5 * z * z);
    }
    return spectrum;
}

/// A wall and a floor that meet at right angles, in front of the projector.
Mesh make_corner() {
    Mesh mesh = make_rectangle({-60, -40, 0}, {120, 0, 0}, {0, 80, 0}, "wall");
    append(mesh, make_rectangle({-60, -40, 80}, {120, 0, 0}, {0, 0, -80}, "floor"), "");
    return mesh;
}

BenchDescription corner_bench() {
    BenchDescription bench = wall_bench();
    bench.projector.view = look_at({0, 250, 400}, {0, -10, 20}, 0.32, 96, 72);
    bench.camera.view = look_at({150, 220, 400}, {0, -10, 20}, 0.32, 96, 72);
    return bench;
}

TEST(Spectral, FoldedFactorsEqualTheSumOverAllBands) {
    BenchDescription bench = corner_bench();
    bench.projector.white_segment = 0.7;
    bench.projector.leak = 0.003;
    bench.ambient = 0.2;
    bench.ambient_spectrum = white_led();
    bench.mockup.interreflection = true;
    bench.mockup.sheen_f0 = 0.05;
    bench.mockup.surfaces["wall"] = {band(620, 25), band(450, 20), 0.6, 15.0};
    bench.mockup.surfaces["floor"] = {band(530, 15), {}, 0.0, 20.0};
    const Mesh mesh = make_corner();
    const Tracer tracer(mesh);
    const SurfaceSet surfaces = make_surfaces(bench, mesh);
    ASSERT_EQ(surfaces.reflectances.size(), 4u);
    const TracedWorld world{mesh, mesh.parts.size(), tracer, surfaces, bench, 450.0};

    for (const auto& sensor : {camera_sensor(bench), observer_sensor()}) {
        TracedReceivers traced;
        traced.width = bench.camera.view.width;
        traced.height = bench.camera.view.height;
        traced.paths = trace_camera(world, {});
        const Receivers receivers{&traced, fold(bench, surfaces, sensor)};
        GatherPlaces places(6.0);
        places.add(traced.paths);
        const Gathers gathers = places.gather(world, 64, {});
        traced.blends = places.blend(traced.paths);
        Image8 drive(96, 72, 3);
        Random random(3);
        for (auto& value : drive.values) value = static_cast<std::uint8_t>(random.below(256));
        const ImageF light = light_from_drive(bench.projector, drive);
        const ImageF folded = receive_all(receivers, gathers, light);

        const auto lights = scaled_lights(bench.projector.spectra);
        const Spectrum ambient = scaled_ambient(bench);
        const LightPaths& paths = traced.paths;
        const auto spectrum_of = [&](const PathTerm& term) {
            Spectrum spectrum{};
            for (std::size_t k = 0; k < spectrum.size(); ++k) {
                for (std::size_t c = 0; c < 4; ++c) {
                    spectrum[k] += term.weight * double(light.values[4 * term.pixel + c]) *
                                   lights[c][k] * surfaces.reflectances[term.surface][k];
                }
            }
            return spectrum;
        };
        int compared = 0;
        for (std::size_t i = 0; i < paths.receiver.size(); i += 53, ++compared) {
            Spectrum power{}, room{};
            for (auto t = paths.term_begin[i]; t < paths.term_begin[i + 1]; ++t) {
                const Spectrum one = spectrum_of(paths.terms[t]);
                for (std::size_t k = 0; k < power.size(); ++k) power[k] += one[k];
            }
            Spectrum bounced{};
            const Gathers::Blend& blend = traced.blends[i];
            for (std::size_t b = 0; b < 8; ++b) {
                if (blend.weight[b] == 0.0f) continue;
                for (auto t = gathers.begin[blend.place[b]]; t < gathers.begin[blend.place[b] + 1];
                     ++t) {
                    const Spectrum one = spectrum_of(gathers.terms[t]);
                    for (std::size_t k = 0; k < bounced.size(); ++k) {
                        bounced[k] += blend.weight[b] * one[k];
                    }
                }
            }
            for (auto c = paths.cover_begin[i]; c < paths.cover_begin[i + 1]; ++c) {
                const Spectrum& seen = surfaces.reflectances[paths.covers[c].surface];
                for (std::size_t k = 0; k < power.size(); ++k) {
                    power[k] += paths.covers[c].share * bounced[k] * seen[k];
                    room[k] += paths.covers[c].share * ambient[k] * seen[k];
                }
            }
            const glm::vec3 own_ambient = receive_ambient(receivers, i);
            for (int c = 0; c < 3; ++c) {
                double expected = 0.0, expected_room = 0.0;
                for (std::size_t k = 0; k < power.size(); ++k) {
                    expected += power[k] * sensor[static_cast<std::size_t>(c)][k];
                    expected_room += room[k] * sensor[static_cast<std::size_t>(c)][k];
                }
                // Float sums of some hundred terms.
                const float got =
                    folded.values[3 * paths.receiver[i] + static_cast<std::size_t>(c)];
                EXPECT_NEAR(got, expected, 2e-5 * expected + 1e-9) << i;
                EXPECT_NEAR(own_ambient[c], expected_room, 1e-5 * expected_room) << i;
            }
        }
        EXPECT_GT(compared, 40);
    }
}

TEST(Spectral, LightBetweenPartsEqualsTheIntegralOverTheWall) {
    // What the lit wall throws on a place of the floor, by quadrature over the wall.
    BenchDescription bench = corner_bench();
    const auto product = product_of(make_corner());
    bench.mockup.surfaces["*"].reflectance = flat(0.8);
    const Bench direct(bench, product);
    bench.mockup.interreflection = true;
    const Bench both(bench, product);
    const Image8 white = filled(bench, 255, 255, 255);
    const ImageF a = direct.observe_xyz(white), b = both.observe_xyz(white);

    const glm::dvec3 projector(0, 250, 400);
    const double reference2 =
        glm::dot(projector - glm::dvec3(0, 0, 40), projector - glm::dvec3(0, 0, 40));
    double measured = 0.0, expected = 0.0;
    int count = 0;
    for (double x = -30.0; x <= 30.0; x += 6.0) {
        for (double z = 12.0; z <= 48.0; z += 4.0) {
            const glm::dvec3 place(x, -40, z);
            const auto pixel = project(bench.projector.view, place);
            ASSERT_TRUE(pixel);
            const int u = static_cast<int>(pixel->x), v = static_cast<int>(pixel->y);
            measured += b.at(u, v, 1) - a.at(u, v, 1);
            double irradiance = 0.0;  // over pi, in units of a white diffuser at the reference
            constexpr int kSteps = 60;
            for (int i = 0; i < kSteps; ++i) {
                for (int j = 0; j < kSteps; ++j) {
                    const glm::dvec3 wall(
                        -60.0 + 120.0 * (i + 0.5) / kSteps, -40.0 + 80.0 * (j + 0.5) / kSteps, 0.0);
                    const glm::dvec3 to_light = projector - wall, step = wall - place;
                    const double lit = 0.8 * to_light.z / glm::length(to_light) * reference2 /
                                       glm::dot(to_light, to_light);
                    const double r2 = glm::dot(step, step);
                    // cos at the floor: step.y / r; at the wall: place.z / r.
                    irradiance += lit * step.y * place.z / (r2 * r2) * (120.0 * 80.0) /
                                  (kSteps * kSteps * 3.14159265358979);
                }
            }
            expected += 0.8 * irradiance;
            ++count;
        }
    }
    // 110 places share some 70 gathers of 256 rays (about 4% each): under 1% in the mean; cells of
    // 6 mm smooth what falls steeply from the wall by another per cent.
    EXPECT_NEAR(measured / expected, 1.0, 0.015) << count;
    EXPECT_GT(measured / count, 0.05);
}

TEST(Spectral, InterreflectionOffIsBitIdenticalAndConvexObjectsHaveNone) {
    BenchDescription bench = wall_bench();
    const Bench off(bench, product_of(make_wall()));
    bench.mockup.interreflection = true;
    const Bench on(bench, product_of(make_wall()));
    const Image8 picture = filled(bench, 200, 100, 50);
    EXPECT_EQ(off.observe_xyz(picture).values, on.observe_xyz(picture).values);
}

TEST(Spectral, SheenAddsItsLobeInTheMirrorDirection) {
    BenchDescription bench = wall_bench();
    bench.eye_mm = {0, 0, 500};  // straight above, where the light comes from
    bench.mockup.sheen_f0 = 0.04;
    bench.mockup.sheen_alpha = 0.4;
    const Bench shiny(bench, product_of(make_wall()));
    const double y = shiny.observe_xyz(filled(bench, 255, 255, 255)).at(80, 60, 1);
    // pi f = f0 / (4 alpha^2) at normal incidence; the paint below gets the rest, 96%.
    EXPECT_NEAR(y, 0.5 * 0.96 + 0.04 / (4.0 * 0.16), 2e-4);
    // Seen from 74 degrees, the half vector tilted by 37: Walter et al.'s forms in tangents.
    bench.eye_mm = {700, 0, 200};
    const Bench aside(bench, product_of(make_wall()));
    const double tilt = std::atan2(700.0, 200.0), half = 0.5 * tilt, a2 = 0.16;
    const double tan2 = std::pow(std::tan(half), 2.0);
    const double pi_d = a2 / (std::pow(std::cos(half), 4.0) * std::pow(a2 + tan2, 2.0));
    const double g = 2.0 / (1.0 + std::sqrt(1.0 + a2 * std::pow(std::tan(tilt), 2.0)));
    const double fresnel = 0.04 + 0.96 * std::pow(1.0 - std::cos(half), 5.0);
    EXPECT_NEAR(aside.observe_xyz(filled(bench, 255, 255, 255)).at(80, 60, 1),
                0.5 * 0.96 + pi_d * g * fresnel / (4.0 * std::cos(tilt)),
                2e-4);
}

TEST(Spectral, ARoughDiffuserIsFlatterThanLambert) {
    BenchDescription bench = wall_bench();
    bench.eye_mm = {0, 0, 500};
    bench.mockup.diffuse_sigma_rad = 0.35;
    const Bench rough(bench, product_of(make_wall()));
    const double s2 = 0.35 * 0.35;
    const double a = 1.0 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
    const ImageF xyz = rough.observe_xyz(filled(bench, 255, 255, 255));
    EXPECT_NEAR(xyz.at(80, 60, 1), 0.5 * a, 1e-3);
    // At an angle, seen from where the light comes: A + B sin tan against Lambert's 1.
    const double cosine = -ray_through(bench.projector.view, {4.5, 4.5}).direction.z;
    const double slant = (1.0 - cosine * cosine) / cosine;
    EXPECT_NEAR(xyz.at(4, 4, 1) / (0.5 * std::pow(cosine, 3.0)), a + b * slant, 1e-3);
}

TEST(Spectral, RoughDiffuseFactorsFollowOrenAndNayarAtSlantedDirections) {
    SurfaceSet surfaces;
    surfaces.reflectances = {flat(0.5), flat(1.0)};
    surfaces.parts = {{}};
    surfaces.sheen = 1;
    surfaces.diffuse_sigma_rad = 0.5;
    const auto at = [](double slant, double azimuth) {
        return glm::dvec3(std::sin(slant) * std::cos(azimuth),
                          std::sin(slant) * std::sin(azimuth),
                          std::cos(slant));
    };
    const auto factor = [&](const glm::dvec3& light, const glm::dvec3& viewer) {
        return surface_factors(surfaces, 0, {}, {0, 0, 1}, light, viewer).list[0].factor;
    };
    const double a = 1.0 - 0.5 * 0.25 / 0.58, b = 0.45 * 0.25 / 0.34;
    // alpha is the larger slant, beta the smaller.
    EXPECT_NEAR(factor(at(1.1, 0.3), at(0.7, 0.3)), a + b * std::sin(1.1) * std::tan(0.7), 1e-12);
    EXPECT_NEAR(factor(at(0.7, 0.3), at(1.1, 1.0)),
                a + b * std::cos(0.7) * std::sin(1.1) * std::tan(0.7),
                1e-12);
    EXPECT_NEAR(factor(at(0.7, 0.0), at(1.1, 2.5)), a, 1e-12);  // seen against the light
    EXPECT_EQ(factor(at(0.7, 0.0), at(1.1, 2.5)), factor(at(1.1, 2.5), at(0.7, 0.0)));
}

TEST(Spectral, ASecondReflectanceIsMixedInByAPatternOfItsSize) {
    BenchDescription bench = wall_bench();
    bench.mockup.surfaces["*"] = {flat(0.6), flat(0.2), 0.5, 20.0};
    const Bench patterned(bench, product_of(make_wall()));
    bench.mockup.surfaces["*"] = {flat(0.6), {}, 0.0, 20.0};
    const Bench plain(bench, product_of(make_wall()));
    const Image8 white = filled(bench, 255, 255, 255);
    const ImageF a = patterned.observe_xyz(white), b = plain.observe_xyz(white);
    double low = 2.0, high = 0.0;
    for (int y = 10; y < 110; ++y) {
        for (int x = 10; x < 150; ++x) {
            const auto ray = ray_through(bench.projector.view, {x + 0.5, y + 0.5});
            const glm::dvec3 place = ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
            const double ratio = a.at(x, y, 1) / b.at(x, y, 1);
            // A pixel is 1.7 mm of a pattern of 20 mm: its mean is near its middle's value.
            EXPECT_NEAR(ratio, 1.0 - 0.5 * pattern_share(place, 20.0) * (2.0 / 3.0), 6e-3);
            low = std::min(low, ratio);
            high = std::max(high, ratio);
        }
    }
    EXPECT_LT(low, 0.75);
    EXPECT_GT(high, 0.92);
}

TEST(Spectral, AmbientLightIsItsShareOfProjectorWhiteEverywhere) {
    BenchDescription bench = wall_bench();
    bench.ambient = 0.1;
    const Bench lit(bench, product_of(make_wall()));
    for (int y = 5; y < 120; y += 20) {
        for (int x = 5; x < 160; x += 30) {
            EXPECT_NEAR(lit.truth().black_xyz.at(x, y, 1), 0.1 * 0.5, 1e-6);
        }
    }
    // D65 off a neutral wall: its chromaticity to the table's rounding.
    const float* xyz = lit.truth().black_xyz.pixel(80, 60);
    EXPECT_NEAR(xyz[0] / xyz[1], d65_xyz().x, 2e-3);
    EXPECT_NEAR(xyz[2] / xyz[1], d65_xyz().z, 2e-3);
}

TEST(Spectral, SynthesisedProjectorsHaveTheWhiteAndTheGamutTheyClaim) {
    const auto chromaticity = [](const Spectrum& power) {
        const glm::dvec3 xyz = xyz_from_power(power);
        return glm::dvec2(xyz.x, xyz.y) / (xyz.x + xyz.y + xyz.z);
    };
    const auto white_of = [](const ProjectorSpectra& projector) {
        Spectrum sum{};
        for (const auto& primary : projector.primaries) {
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += primary[k];
        }
        return sum;
    };
    const auto area = [&](const ProjectorSpectra& projector) {
        const glm::dvec2 r = chromaticity(projector.primaries[0]),
                         g = chromaticity(projector.primaries[1]),
                         b = chromaticity(projector.primaries[2]);
        return 0.5 * std::abs((g.x - r.x) * (b.y - r.y) - (b.x - r.x) * (g.y - r.y));
    };
    EXPECT_NEAR(glm::distance(chromaticity(white_of(uhp_projector())), {0.3050, 0.3250}), 0, 1e-9);
    EXPECT_NEAR(glm::distance(chromaticity(white_of(led_projector())), {0.3127, 0.3290}), 0, 1e-9);
    for (const auto& projector : {uhp_projector(), led_projector()}) {
        for (const auto& primary : projector.primaries) {
            for (const double value : primary) EXPECT_GE(value, 0.0);
        }
    }
    // Rec.709's triangle has .1121: both hold more, the LEDs most.
    EXPECT_GT(area(uhp_projector()), 0.1121);
    EXPECT_GT(area(led_projector()), 1.05 * area(uhp_projector()));
}

TEST(Spectral, GreySprayPaintIsNearlyNeutral) {
    const glm::dvec3 xyz = xyz_from_reflectance(grey_spray_paint(), illuminant_d65());
    EXPECT_GT(xyz.y, 0.5);
    EXPECT_LT(xyz.y, 0.6);
    const glm::dvec3 lab = lab_from_xyz(xyz / xyz.y, d65_xyz());
    EXPECT_LT(std::hypot(lab.y, lab.z), 4.0);
}

}  // namespace
}  // namespace livery
