#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "radiance/light/mirror_quadrature.h"
#include "radiance/light/mirrored_environment.h"
#include "radiance/light/sky_visibility.h"

namespace livery {
namespace {

/// Turned and scaled, with a lamp 0.15 rad wide.
Environment sky() {
    Environment environment;
    environment.radiance_working = ImageF(256, 128, 3);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 256; ++x) {
            const glm::dvec3 d =
                direction_from_uv(environment, {(x + 0.5) / 256.0, (y + 0.5) / 128.0});
            const glm::dvec3 away = d - glm::normalize(glm::dvec3(1.0, 0.5, -0.4));
            const double lamp = 5.0 * std::exp(-0.5 * glm::dot(away, away) / (0.15 * 0.15));
            const glm::dvec3 light(1.5 + d.x + lamp, 1.5 + d.y, 1.0 + d.z * d.z);
            for (int c = 0; c < 3; ++c) {
                environment.radiance_working.at(x, y, c) = static_cast<float>(light[c]);
            }
        }
    }
    environment.rotation_rad = 2.3;
    environment.scale = 0.7;
    return environment;
}

/// One lobe of one fragment, from the library's look-ups and mirror_correction() itself.
glm::dvec3 expected(const Environment& environment,
                    const std::vector<ImageF>& pictures,
                    const Fragment& f,
                    const glm::dvec3& eye_mm,
                    std::size_t lobe) {
    const auto alpha = static_cast<double>(kMirrorAlphas[lobe]);
    const glm::dvec3 n = f.normal, wo = glm::normalize(glm::dvec3(toward_eye(f, eye_mm)));
    const double cosine = glm::dot(n, wo);
    const glm::dvec3 mirrored = 2.0 * cosine * n - wo;
    const double leans = (1.0 - alpha) * (std::sqrt(1.0 - alpha) + alpha);
    const double first2 = std::pow(static_cast<double>(kLayerAlphas[1]), 2.0);
    const double ratio = (alpha * alpha + static_cast<double>(f.normal_variance)) / first2;
    const double octave = std::floor(std::log2(ratio));
    const double layer = ratio < 1.0 ? std::sqrt(ratio)
                                     : std::min(1.0 + octave + ratio / std::exp2(octave) - 1.0,
                                                static_cast<double>(pictures.size() - 1));
    const std::size_t below = std::min(static_cast<std::size_t>(layer), pictures.size() - 2);
    const auto in = [&](std::size_t k) {
        const bool wide = pictures[k].width != pictures.front().width;
        const glm::dvec3 along =
            wide && leans < 0.95 ? glm::normalize(n + leans * (mirrored - n)) : mirrored;
        return glm::dvec3(sample_sphere(pictures[k], uv_from_direction(environment, along)));
    };
    const double share = layer - static_cast<double>(below);
    return environment.scale * mirror_correction(cosine, alpha) *
           ((1.0 - share) * in(below) + share * in(below + 1));
}

TEST(MirrorLookUp, IsTheFilteredPictureOfEachLobeWithEveryInstructionSet) {
    const Environment environment = sky();
    const FilteredEnvironment filtered =
        filter_environment(environment, {true, false, false, false});
    const MirrorLookUp look_up(filtered);
    const MirrorLobes lobes(MirrorLayers((1u << kMirrorAlphas.size()) - 1u));
    const glm::dvec3 eye_mm(300.0, 1500.0, -2000.0);
    std::mt19937 random(20261127);
    std::normal_distribution<float> normal;
    // Seven in a block: the eighth lane is nobody's
    std::vector<Fragment> fragments(7 * 40);
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        Fragment& f = fragments[i];
        // Of all directions, so that half of them face away from the eye
        f.normal = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        f.position_mm = 200.0f * glm::vec3(normal(random), normal(random), normal(random));
        f.normal_variance = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 2e-4f : 0.3f;
    }
    for (std::size_t set = 0; set < lanes_available(); ++set) {
        SCOPED_TRACE(lanes_available(set).instruction_set);
        const MirrorLookUp::In in(look_up, environment, eye_mm, lobes, lanes_available(set));
        for (std::size_t first = 0; first < fragments.size(); first += 7) {
            std::array<const Fragment*, 7> some;
            for (std::size_t n = 0; n < some.size(); ++n) some[n] = &fragments[first + n];
            std::array<MirroredLight, kNodeBlock> light;
            in.at_fragments(some, light);
            for (std::size_t n = 0; n < some.size(); ++n) {
                for (std::size_t lobe = 0; lobe < kMirrorAlphas.size(); ++lobe) {
                    const glm::dvec3 right =
                        expected(environment, filtered.mirrored, *some[n], eye_mm, lobe);
                    // Places are single: 2e-5 rad on slopes of 33 a radian; the correction is
                    // tabulated, and within .7% of 1
                    for (int c = 0; c < 3; ++c) {
                        EXPECT_NEAR(light[n][lobe][c], right[c], 1e-3 + 2e-3 * right[c])
                            << "fragment " << first + n << ", lobe " << lobe;
                    }
                }
                for (std::size_t k = kMirrorAlphas.size(); k < kMirrorLayers; ++k) {
                    EXPECT_EQ(light[n][k], glm::vec3(1.0f));
                }
            }
        }
    }
}

TEST(MirrorLookUp, OfWhatIsNoNumberIsNone) {
    const Environment environment = sky();
    const MirrorLookUp look_up(filter_environment(environment, {true, false, false, false}));
    const MirrorLobes lobes(MirrorLayers((1u << kMirrorAlphas.size()) - 1u));
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::array<Fragment, 4> fragments;
    for (Fragment& f : fragments) f.normal = {0.0f, 0.0f, 1.0f};
    fragments[0].normal.y = kNone;
    fragments[1].position_mm = {100.0f, 200.0f, 300.0f};  // where the eye is
    fragments[2].normal_variance = -kNone;
    const std::array<const Fragment*, 4> all{
        &fragments[0], &fragments[1], &fragments[2], &fragments[3]};
    for (std::size_t set = 0; set < lanes_available(); ++set) {
        SCOPED_TRACE(lanes_available(set).instruction_set);
        const MirrorLookUp::In in(
            look_up, environment, {100.0, 200.0, 300.0}, lobes, lanes_available(set));
        std::array<MirroredLight, kNodeBlock> light;
        in.at_fragments(all, light);
        for (std::size_t lobe = 0; lobe < kMirrorAlphas.size(); ++lobe) {
            for (std::size_t n = 0; n < 3; ++n) {
                EXPECT_TRUE(std::isnan(light[n][lobe].x)) << "fragment " << n << ", lobe " << lobe;
            }
            EXPECT_GT(light[3][lobe].x, 0.0f);
        }
    }
}

}  // namespace
}  // namespace livery
