#include "radiance/light/environment_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "radiance/lanes/lane_functions.h"
#include "radiance/light/sphere_lookup.h"
#include "radiance/light/spherical_harmonics.h"

namespace livery {
namespace {

template <typename Radiance>
Environment environment_of(int width, int height, const Radiance& radiance) {
    Environment environment;
    environment.radiance_working = ImageF(width, height, 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 d =
                direction_from_uv(environment, {(x + 0.5) / width, (y + 0.5) / height});
            const glm::dvec3 value = radiance(d);
            for (int c = 0; c < 3; ++c) {
                environment.radiance_working.at(x, y, c) = static_cast<float>(value[c]);
            }
        }
    }
    return environment;
}

glm::vec3 towards(const Environment& environment, const ImageF& picture, glm::dvec3 direction) {
    return sample_sphere(picture, uv_from_direction(environment, direction));
}

/// Mean over the lobe seen along `axis` by brute force: the definition that the kernel implements.
double lobe_mean(double alpha, glm::dvec3 axis, const std::function<double(glm::dvec3)>& radiance) {
    const glm::dvec3 s = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 0.5, -0.8)));
    const glm::dvec3 t = glm::cross(axis, s);
    double sum = 0.0, total = 0.0;
    const int rings = 800, sectors = 256;
    for (int i = 0; i < rings; ++i) {
        const double theta = std::numbers::pi / 2.0 * std::pow((i + 0.5) / rings, 2.0);
        const double width = std::numbers::pi / 2.0 * 2.0 * ((i + 0.5) / rings) / rings;
        const double c = std::cos(0.5 * theta), s2 = std::pow(std::sin(0.5 * theta), 2.0);
        const double k = alpha / (s2 + c * c * alpha * alpha);
        const double mu = std::cos(theta);
        const double g2 =
            2.0 * mu / (mu + std::sqrt(alpha * alpha + (1 - alpha * alpha) * mu * mu));
        const double weight = k * k * g2 * std::sin(theta) * width;
        for (int j = 0; j < sectors; ++j) {
            const double phi = 2.0 * std::numbers::pi * (j + 0.5) / sectors;
            sum += weight *
                   radiance(mu * axis + std::sin(theta) * (std::cos(phi) * s + std::sin(phi) * t));
            total += weight;
        }
    }
    return sum / total;
}

/// Smooth, with three lamps of different size, the smallest 0.03 rad wide.
double lamps(glm::dvec3 d) {
    const auto lamp = [&](glm::dvec3 at, double width, double power) {
        const glm::dvec3 away = d - glm::normalize(at);
        return power * std::exp(-0.5 * glm::dot(away, away) / (width * width));
    };
    return 0.4 + 0.3 * d.y + lamp({1, 1, 0.4}, 0.03, 60.0) + lamp({-1, 0.5, 1}, 0.15, 5.0) +
           lamp({0.1, 0.9, -1}, 0.4, 2.0);
}

TEST(EnvironmentFilter, ConstantStaysConstant) {
    const Environment grey = environment_of(64, 32, [](glm::dvec3) { return glm::dvec3(0.7); });
    const FilteredEnvironment filtered = filter_environment(grey, {});
    ASSERT_EQ(filtered.mirrored.size(), kLayerAlphas.size());
    for (const ImageF& layer : filtered.mirrored) {
        // Quadrature is exact here; float storage and 512 rows' rounding leave 1e-6.
        for (const float value : layer.values) ASSERT_NEAR(value, 0.7f, 1e-5f);
    }
    for (const ImageF& layer : filtered.gaussians) {
        for (const float value : layer.values) ASSERT_NEAR(value, 0.7f, 1e-5f);
    }
    for (const float value : filtered.diffuse.values) ASSERT_NEAR(value, 0.7f, 1e-5f);
    for (const float value : filtered.blurred.values) ASSERT_NEAR(value, 0.7f, 1e-5f);
    for (const float value : filtered.hardly_blurred.values) ASSERT_NEAR(value, 0.7f, 1e-5f);
}

TEST(EnvironmentFilter, DiffuserUnderALinearSkyHasTheClosedForm) {
    // L = 1 + a.d gives irradiance / pi = 1 + 2/3 a.n; and d.y^2 gives 1/4 + n.y^2/4.
    const glm::dvec3 a(0.3, -0.4, 0.2);
    const Environment sky = environment_of(1024, 512, [&](glm::dvec3 d) {
        return glm::dvec3(1.0 + glm::dot(a, d), d.y * d.y, 1.0 - d.y * d.y);
    });
    const FilteredEnvironment filtered = filter_environment(sky, {false, true, false, false});
    EXPECT_TRUE(filtered.mirrored.empty());
    EXPECT_TRUE(filtered.blurred.empty());
    for (const glm::dvec3 n : {glm::dvec3(0, 1, 0.01),
                               glm::dvec3(1, 0.2, 0.3),
                               glm::dvec3(-1, -1, 1),
                               glm::dvec3(0.2, -1, -0.1),
                               glm::dvec3(-0.01, 0, 1)}) {
        const glm::dvec3 unit = glm::normalize(n);
        const glm::vec3 found = towards(sky, filtered.diffuse, unit);
        // Bilinear on 256 columns: (2 pi / 256)^2 / 8 of a curvature of order 1, twice.
        EXPECT_NEAR(found.x, 1.0 + 2.0 / 3.0 * glm::dot(a, unit), 4e-4);
        EXPECT_NEAR(found.y, 0.25 + 0.25 * unit.y * unit.y, 2e-4);
        EXPECT_NEAR(found.z, 0.75 - 0.25 * unit.y * unit.y, 2e-4);
    }
}

TEST(EnvironmentFilter, DiffuserUnderAHalfSky) {
    // Light from y > 0 only: a normal at angle t from up sees (1 + cos t) / 2. The step has energy
    // in every degree; the cosine's series stops at 48, which leaves under 5e-4.
    const Environment half =
        environment_of(1024, 512, [](glm::dvec3 d) { return glm::dvec3(d.y > 0.0 ? 1.0 : 0.0); });
    const FilteredEnvironment filtered = filter_environment(half, {false, true, false, false});
    for (double t = 0.05; t < std::numbers::pi; t += 0.15) {
        const glm::dvec3 n(std::sin(t), std::cos(t), 0.0);
        EXPECT_NEAR(towards(half, filtered.diffuse, n).x, 0.5 + 0.5 * std::cos(t), 1e-3);
    }
}

TEST(EnvironmentFilter, LayersAreMeansOverTheirLobes) {
    const Environment environment =
        environment_of(1024, 512, [](glm::dvec3 d) { return glm::dvec3(lamps(d)); });
    const FilteredEnvironment filtered =
        filter_environment(environment, {true, false, false, false});
    for (const std::size_t layer : {1u, 2u, 4u, 6u, 7u, 8u, 10u, 12u}) {
        const double alpha = static_cast<double>(kLayerAlphas[layer]);
        for (const glm::dvec3 axis : {glm::dvec3(1, 1, 0.4),
                                      glm::dvec3(1, 1, 0.45),
                                      glm::dvec3(1, 1.2, 0.4),
                                      glm::dvec3(-1, 0.4, 1),
                                      glm::dvec3(0.02, 1, 0.01),
                                      glm::dvec3(0, -1, 0.2)}) {
            const glm::dvec3 unit = glm::normalize(axis);
            const double expected = lobe_mean(alpha, unit, lamps);
            // Bilinear interpolation of a lamp .03 rad wide on texels of .012 rad: up to h^2 / 4
            // sigma^2 = 4% between texels.
            EXPECT_NEAR(towards(environment, filtered.mirrored[layer], unit).x,
                        expected,
                        0.04 * expected + 1e-3)
                << "alpha " << alpha;
        }
    }
}

TEST(EnvironmentFilter, LobesHaveTheirFirstTwoMoments) {
    // The kernel's degrees 1 and 2: the lobe's means of the cosine and of Legendre's second
    // polynomial, by how much they fall short of 1.
    const glm::dvec3 axis(0.0, 0.6, 0.8);
    for (const double alpha : {0.05, 0.2, 0.5}) {
        const std::vector<double> kernel = ggx_lobe_kernel(alpha, 8);
        const auto cosine = [&](const glm::dvec3& d) { return glm::dot(d, axis); };
        const double first = lobe_mean(alpha, axis, cosine);
        const double second = lobe_mean(
            alpha, axis, [&](const glm::dvec3& d) { return 1.5 * cosine(d) * cosine(d) - 0.5; });
        EXPECT_NEAR(1.0 - kernel[1], 1.0 - first, 0.004 * (1.0 - first)) << "alpha " << alpha;
        EXPECT_NEAR(1.0 - kernel[2], 1.0 - second, 0.004 * (1.0 - second)) << "alpha " << alpha;
    }
}

TEST(EnvironmentFilter, OtherSizesAreTakenAndRotationOnlyTurns) {
    Environment small = environment_of(90, 45, [](glm::dvec3 d) { return glm::dvec3(1.0 + d.x); });
    const FilteredEnvironment filtered = filter_environment(small, {false, true, false, false});
    EXPECT_NEAR(towards(small, filtered.diffuse, {1, 0, 0}).x, 1.0 + 2.0 / 3.0, 3e-3);
    small.rotation_rad = std::numbers::pi / 2.0;
    const glm::dvec3 where = direction_from_uv(small, {0.75, 0.5});
    EXPECT_NEAR(towards(small, filtered.diffuse, where).x, 1.0 + 2.0 / 3.0, 3e-3);
}

TEST(SphereLookup, PlacesAreThoseOfTheExactFunction) {
    Environment environment;
    for (const double rotation_rad : {0.0, 1.0, -4.0}) {
        environment.rotation_rad = rotation_rad;
        const SpherePlaces places(environment);
        for (int k = 0; k < 20000; ++k) {
            // A spiral from pole to pole, and the axes themselves
            const double y = 1.0 - 2.0 * (k + 0.5) / 20000.0, angle = 2.399963 * k;
            glm::dvec3 d(std::sqrt(1.0 - y * y) * std::cos(angle),
                         y,
                         std::sqrt(1.0 - y * y) * std::sin(angle));
            if (k < 6) d = glm::dvec3(k == 0, k == 1, k == 2) - glm::dvec3(k == 3, k == 4, k == 5);
            const glm::dvec2 exact = uv_from_direction(environment, d);
            const glm::vec2 found = places.of(glm::vec3(d));
            const double around = std::abs(static_cast<double>(found.x) - exact.x);
            // At a pole every azimuth is right
            if (std::abs(d.y) < 1.0) {
                EXPECT_LT(std::min(around, 1.0 - around), 3e-6);
            }
            EXPECT_NEAR(static_cast<double>(found.y), exact.y, 3e-6);
            ASSERT_FALSE(HasFailure()) << d.x << " " << d.y << " " << d.z;
        }
    }
}

TEST(SphereLookup, OfNoPlaceIsNoNumber) {
    const ImageF picture(8, 4, 3, 1.0f);
    const SphereStack stack({&picture, 1});
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (const glm::vec2 place : {glm::vec2(kNone, 0.5f), glm::vec2(0.5f, kNone)}) {
        EXPECT_TRUE(std::isnan(stack.at(place).in(0)[0]));
    }
    EXPECT_FLOAT_EQ(stack.at({0.0f, 0.0f}).in(0)[0], 1.0f);
    EXPECT_FLOAT_EQ(stack.at({0.999f, 1.0f}).in(0)[0], 1.0f);
}

/// What a sum over one node sees along a direction, under a Gaussian of that variance.
glm::vec3 seen_along(const GaussianLayers& layers,
                     const Environment& sky,
                     const glm::dvec3& direction,
                     float variance,
                     const LaneFunctions& sums) {
    std::array<float, kRowLists * kNodeBlock> row{};
    std::fill_n(row.begin() + kHalfVectorZ * kNodeBlock, kNodeBlock, 1.0f);
    row[kVariance * kNodeBlock] = variance;
    row[kFirstLobe * kNodeBlock] = row[kLastLobe * kNodeBlock] = 1.0f;
    MirrorFacet facet{};
    for (int c = 0; c < 3; ++c) {
        facet.normal[c] = facet.to_eye[c] = static_cast<float>(direction[c]);
    }
    facet.below = facet.above = row.data();
    const int lobe = 0;
    const bool grazes = false;
    std::array<float, kNodeLists * kNodeBlock> light{};
    std::array<float, kNodeLists> sum{};
    MirrorSumJob job;
    job.sharp = layers.sharp();
    job.wide = layers.wide();
    job.turns = SpherePlaces(sky).turns();
    job.variance_of_first = kFirstGaussian_rad * kFirstGaussian_rad;
    job.facets = &facet;
    job.facet_count = 1;
    job.nodes = kNodeBlock;
    job.lobes = &lobe;
    job.grazes = &grazes;
    job.lobe_count = 1;
    job.light = light.data();
    job.sums = sum.data();
    sums.sum_mirrored(job);
    return {sum[0], sum[1], sum[2]};
}

TEST(EnvironmentFilter, GaussiansMixToTheVarianceAskedFor) {
    // Under a Gaussian of variance v, a linear sky keeps exp(-v) of its slope and a quadratic one
    // exp(-3 v): the heat kernel's degrees 1 and 2. A mixture of two has the variance asked for;
    // its fourth moment, not quite: (v / 3)^2 of the second degree.
    const Environment sky = environment_of(
        1024, 512, [](glm::dvec3 d) { return glm::dvec3(1.0 + d.x, 1.0 + d.y * d.y, 1.0); });
    const FilteredEnvironment filtered = filter_environment(sky, {false, false, false, true});
    ASSERT_EQ(filtered.gaussians.size(), kGaussianLayers);
    EXPECT_TRUE(filtered.mirrored.empty());
    const GaussianLayers layers(filtered);
    for (const glm::dvec3 to :
         {glm::dvec3(1, 0.1, 0.2), glm::dvec3(0.1, 1, 0), glm::dvec3(-1, -1, 1)}) {
        const glm::dvec3 d = glm::normalize(to);
        for (const double v : {0.0, 1e-4, 2e-4, 3e-4, 1e-3, 5e-3, 7e-3, 0.01, 0.03, 0.15, 0.4}) {
            for (std::size_t k = 0; k < lanes_available(); ++k) {
                const LaneFunctions& sums = lanes_available(k);
                SCOPED_TRACE(::testing::Message() << sums.instruction_set << " " << v);
                const glm::vec3 found = seen_along(layers, sky, d, static_cast<float>(v), sums);
                const double tolerance = 1e-3 + 0.5 * v * v;
                EXPECT_NEAR(found.x, 1.0 + std::exp(-v) * d.x, tolerance);
                EXPECT_NEAR(
                    found.y, 4.0 / 3.0 + std::exp(-3.0 * v) * (d.y * d.y - 1.0 / 3.0), tolerance);
                EXPECT_NEAR(found.z, 1.0, 1e-4);
            }
        }
        // The widest by itself
        const double sigma = static_cast<double>(kFirstGaussian_rad) *
                             std::pow(2.0, 0.5 * static_cast<double>(kGaussianLayers - 2));
        const glm::vec3 widest = towards(sky, filtered.gaussians.back(), d);
        EXPECT_NEAR(widest.x, 1.0 + std::exp(-sigma * sigma) * d.x, 6e-4);
    }
}

TEST(SphericalHarmonicsTransform, RoundTripKeepsABandLimitedPicture) {
    const Environment environment = environment_of(128, 64, [](glm::dvec3 d) {
        return glm::dvec3(d.x * d.y + 0.3 * d.z, 1.0 + d.x * d.x * d.z, std::pow(d.y, 5.0));
    });
    const SphericalHarmonics harmonics = analyse_sphere(environment.radiance_working, 15);
    const std::vector<std::vector<double>> same{std::vector<double>(16, 1.0)};
    const ImageF back = synthesise_sphere(harmonics, same, 128, 64).front();
    for (std::size_t i = 0; i < back.values.size(); ++i) {
        ASSERT_NEAR(back.values[i], environment.radiance_working.values[i], 1e-5);
    }
}

TEST(SphericalHarmonicsTransform, RefusesSizesThatItCannotTransform) {
    EXPECT_THROW(analyse_sphere(ImageF(100, 50, 3), 10), std::invalid_argument);
    EXPECT_THROW(analyse_sphere(ImageF(64, 32, 3), 40), std::invalid_argument);
    EXPECT_THROW(analyse_sphere(ImageF(64, 32, 1), 10), std::invalid_argument);
}

}  // namespace
}  // namespace livery
