// Lobes between those that are tabulated: which of them a paint reads.
#include "radiance/light/mirror_lobes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "radiance/shading.h"
#include "scenes.h"

namespace livery {
namespace {

constexpr std::array kMixings{MirrorMixing::cubic, MirrorMixing::linear};

std::size_t lobes_read(const MirrorMix& mix) {
    return static_cast<std::size_t>(
        std::count_if(mix.share.begin(), mix.share.end(), [](float s) { return s != 0.0f; }));
}

TEST(MirrorLobes, ATabulatedOneIsReadAlone) {
    for (std::size_t k = 0; k < kMirrorAlphas.size(); ++k) {
        SCOPED_TRACE(kMirrorAlphas[k]);
        for (const MirrorMixing mixing : kMixings) {
            const MirrorMix mix = mirror_mix(static_cast<double>(kMirrorAlphas[k]), mixing);
            EXPECT_EQ(lobes_read(mix), 1u);
            EXPECT_EQ(mix.share.at(k - static_cast<std::size_t>(mix.first)), 1.0f);
        }
    }
    // Narrower ones and wider ones are the first and the last
    EXPECT_EQ(mirror_mix(1e-4, MirrorMixing::cubic).share[0], 1.0f);
    EXPECT_EQ(mirror_mix(1.0, MirrorMixing::linear).share[3], 1.0f);
}

TEST(MirrorLobes, BetweenTwoTheirLogarithmsAreInterpolated) {
    // Both mixings reproduce what is linear in the logarithm, and the cubic one what is cubic.
    const auto power = [](double alpha, int n) { return std::pow(std::log(alpha), n); };
    for (double alpha = 0.0031; alpha < 0.99; alpha *= 1.07) {
        SCOPED_TRACE(alpha);
        for (const MirrorMixing mixing : kMixings) {
            const MirrorMix mix = mirror_mix(alpha, mixing);
            const bool cubic = mixing == MirrorMixing::cubic && alpha > 0.0055 && alpha < 0.5;
            const bool between = lobes_read(mix) > 1;
            EXPECT_EQ(lobes_read(mix), !between ? 1u : cubic ? 4u : 2u);
            for (int n = 0; n <= (cubic && between ? 3 : 1); ++n) {
                double sum = 0.0;
                for (std::size_t k = 0; k < mix.share.size(); ++k) {
                    const auto lobe = static_cast<std::size_t>(mix.first) + k;
                    sum += static_cast<double>(mix.share[k]) *
                           power(static_cast<double>(kMirrorAlphas[lobe]), n);
                }
                // A thousandth of alpha is as good as alpha
                EXPECT_NEAR(sum, power(alpha, n), between ? 1e-5 * power(0.003, 2) : 2e-3);
            }
        }
    }
}

TEST(MirrorLobes, WhoReadsTheSharesMissesNoLobe) {
    // Shaders take the first share for what the three others leave of one: where that is none, to
    // the last bit, the first lobe may be absent.
    for (double alpha = 0.003; alpha < 1.0; alpha *= 1.003) {
        for (const MirrorMixing mixing : kMixings) {
            SCOPED_TRACE(alpha);
            Material paint = paint_of(ReflectanceModel::ggx, 0.2);
            paint.alpha = glm::dvec2(alpha);
            const glm::vec4 told = uniforms_of(paint, 0.0, mixing).lobe_layers[0];
            const MirrorLayers layers = mirror_layers_of(paint, mixing);
            const std::array<float, 4> share{
                1.0f - told.y - told.z - told.w, told.y, told.z, told.w};
            for (std::size_t k = 0; k < share.size(); ++k) {
                EXPECT_EQ(share[k] != 0.0f, layers[static_cast<std::size_t>(told.x) + k]);
            }
        }
    }
}

}  // namespace
}  // namespace livery
