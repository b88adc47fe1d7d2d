#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "appearance/bsdf.h"
#include "appearance/model_table.h"
#include "radiance/lanes/lane_functions.h"
#include "radiance/light/mirror_quadrature.h"

namespace livery {
namespace {

constexpr std::size_t kBlocks = 300, kLayers = 5;

/// Inputs as they may be: lights below the horizon, denormal half floats, no light at all.
struct Inputs {
    std::vector<float> eye, first_light, second_light, places;
    std::vector<std::uint16_t> diffuse, grazing;
    std::array<std::vector<std::uint16_t>, kLayers> mirror;

    Inputs() {
        std::mt19937 random(3);
        std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
        const auto directions = [&](std::vector<float>& values, float lowest_z, bool visibility) {
            values.resize(kBlocks * 4 * kLaneBlock);
            for (std::size_t i = 0; i < kBlocks * kLaneBlock; ++i) {
                float* at = &values[i / kLaneBlock * 4 * kLaneBlock + i % kLaneBlock];
                const float phi = 3.1f * uniform(random);
                const float z = std::max(uniform(random), lowest_z);
                const float sine = std::sqrt(1.0f - z * z);
                at[0] = sine * std::cos(phi);
                at[kLaneBlock] = sine * std::sin(phi);
                at[2 * kLaneBlock] = z;
                const float other = uniform(random);
                at[3 * kLaneBlock] = visibility ? std::max(other, 0.0f) : 1e-3f * std::abs(other);
            }
        };
        directions(eye, 1e-4f, false);
        directions(first_light, -1.0f, true);
        directions(second_light, -1.0f, true);
        places.resize(eye.size());
        for (float& value : places) value = 100.0f * uniform(random);
        for (std::size_t i = 0; i < kBlocks * kLaneBlock; ++i) {
            float& side = places[i / kLaneBlock * 4 * kLaneBlock + i % kLaneBlock + 3 * kLaneBlock];
            side = std::max(0.02f * side, 0.0f);
        }
        const auto halves = [&](std::vector<std::uint16_t>& values, int largest) {
            std::uniform_int_distribution<int> finite(0, largest);
            values.resize(kBlocks * 3 * kLaneBlock);
            for (std::uint16_t& value : values) {
                value = static_cast<std::uint16_t>(finite(random));
            }
        };
        constexpr int kLargestHalf = 0x7bff, kTwo = 0x4000;
        halves(diffuse, kLargestHalf);
        for (auto& layer : mirror) halves(layer, kLargestHalf);
        halves(grazing, kTwo);
    }
};

/// The last one twice, with glints too.
constexpr int kGlints = 4;
constexpr std::array kModels{ReflectanceModel::lambert,
                             ReflectanceModel::ggx,
                             ReflectanceModel::clearcoat,
                             ReflectanceModel::car_paint,
                             ReflectanceModel::car_paint};

PreparedPaint prepared_of(int model) {
    BsdfParameters p{};
    p.diffuse = {0.2f, 0.4f, 0.8f};
    p.f0 = {0.3f, 0.1f, 0.05f};
    p.alpha_x = 0.3f;
    p.alpha_y = 0.15f;
    p.flake_f0 = {0.1f, 0.2f, 0.5f};
    p.flake_alpha = 0.1f;
    p.film_nm = 320.0f;
    p.film_eta = 2.3f;
    p.coat_alpha = 0.02f;
    p.coat_f0 = 0.04f;
    p.coat_transmittance = {0.93f, 0.25f, 1e-6f};
    return model_info(kModels[static_cast<std::size_t>(model)]).prepared.of(p);
}

std::vector<float> shaded(const LaneFunctions& functions,
                          int model,
                          bool environment,
                          const std::function<void(Inputs&)>& spoil = {}) {
    Inputs inputs;
    if (spoil) spoil(inputs);
    const std::array<const float*, 2> lights{inputs.first_light.data(), inputs.second_light.data()};
    std::array<const std::uint16_t*, kLayers> mirror;
    for (std::size_t k = 0; k < kLayers; ++k) mirror[k] = inputs.mirror[k].data();
    const std::array<float, 6> irradiance{3.0f, 2.9f, 2.8f, 0.5f, 0.6f, 0.7f};
    const std::array<float, 2> radius2{7e-4f, 0.0f};
    std::vector<float> colours(kBlocks * kLaneBlock * 4);
    LaneJob job;
    job.exposure = 1.5f;
    const PreparedPaint paint = prepared_of(model);
    job.prepared = paint.numbers.data();
    const std::array<float, 12> layers{
        1.0f, 0.5f, 0.3f, -0.05f, 0.0f, 0.6f, 0.2f, -0.05f, 1.0f, 0.55f, 0.6f, -0.06f};
    job.lobe_layers = layers.data();
    job.eye = inputs.eye.data();
    job.lights = lights.data();
    job.light_irradiance = irradiance.data();
    job.light_radius2 = radius2.data();
    job.light_count = 2;
    job.lit = job.sky = inputs.diffuse.data();
    job.mirror = mirror.data();
    job.mirror_unit = 1.25f;
    std::array<const std::uint16_t*, kGrazingLayers> grazing;
    grazing.fill(inputs.grazing.data());
    job.grazing = grazing.data();
    job.places = inputs.places.data();
    job.glint_density = 200.0f;
    job.shaded = colours.data();
    job.end_block = kBlocks;
    const ModelInfo& info = model_info(kModels[static_cast<std::size_t>(model)]);
    functions.of(info.prepared.type, environment, model == kGlints)(job);
    return colours;
}

TEST(LaneShading, KnowsEveryModelThatIsPrepared) {
    int known = 0;
    for (const ModelInfo& model : formula_models()) {
        if (!model.prepared.type) continue;
        ++known;
        for (std::size_t k = 0; k < lanes_available(); ++k) {
            EXPECT_NE(lanes_available(k).of(model.prepared.type, true, false), nullptr)
                << model.name;
        }
    }
    EXPECT_EQ(known, 4);
    EXPECT_EQ(best_lanes().of("NoSuchStruct", true, false), nullptr);
}

TEST(LaneShading, EveryInstructionSetGivesTheSameBits) {
    for (int model = 0; model < 5; ++model) {
        for (const bool environment : {false, true}) {
            const std::vector<float> best = shaded(best_lanes(), model, environment);
            for (std::size_t i = 0; i < best.size(); ++i) {
                ASSERT_TRUE(std::isfinite(best[i]) && best[i] >= 0.0f) << i;
            }
            for (std::size_t k = 1; k < lanes_available(); ++k) {
                EXPECT_EQ(shaded(lanes_available(k), model, environment), best) << model;
            }
        }
    }
    EXPECT_STREQ(lanes_available(lanes_available() - 1).instruction_set, "portable");
}

TEST(LaneShading, WhatIsNoNumberStaysNone) {
    // One input of one fragment; a half float's NaN where there are half floats. What comes out
    // must be no number either: as a number it would be the brightest light that there is.
    constexpr std::size_t kBlock = 7, kLane = 3;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr std::uint16_t kHalfNan = 0x7e00;
    const auto four = [](std::vector<float>& values, std::size_t component, float value) {
        values[(4 * kBlock + component) * kLaneBlock + kLane] = value;
    };
    const auto three = [](std::vector<std::uint16_t>& values) {
        for (std::size_t c = 0; c < 3; ++c) {
            values[(3 * kBlock + c) * kLaneBlock + kLane] = kHalfNan;
        }
    };
    const std::pair<const char*, std::function<void(Inputs&)>> spoils[] = {
        {"light of the diffuse layer", [&](Inputs& i) { three(i.diffuse); }},
        {"eye", [&](Inputs& i) { four(i.eye, 2, kNan); }},
        {"light's direction", [&](Inputs& i) { four(i.first_light, 2, kNan); }},
        {"light's visibility", [&](Inputs& i) { four(i.first_light, 3, kNan); }},
        {"mirrored light", [&](Inputs& i) { three(i.mirror[1]); }},
    };
    for (std::size_t k = 0; k < lanes_available(); ++k) {
        const LaneFunctions& functions = lanes_available(k);
        for (int model = 0; model < 5; ++model) {
            const std::vector<float> good = shaded(functions, model, true);
            for (const auto& [name, spoil] : spoils) {
                const bool lambert = model == 0, of_lambert = &spoil == &spoils[0].second;
                if (lambert != of_lambert && lambert) continue;  // reads nothing else
                SCOPED_TRACE(::testing::Message()
                             << functions.instruction_set << ", model " << model << ": " << name);
                const std::vector<float> bad = shaded(functions, model, true, spoil);
                for (std::size_t i = 0; i < bad.size(); ++i) {
                    const bool spoiled = i / 4 == kBlock * kLaneBlock + kLane && i % 4 < 3;
                    ASSERT_EQ(std::isnan(bad[i]), spoiled) << i;
                    if (!spoiled) {
                        ASSERT_EQ(bad[i], good[i]) << i;
                    }
                }
            }
        }
    }
}

TEST(LaneShading, WritesItsBlocksOnly) {
    const Inputs inputs;
    std::vector<float> colours(kBlocks * kLaneBlock * 4, -1.0f);
    LaneJob job;
    const std::array<float, 3> diffuse{0.5f, 0.5f, 0.5f};
    job.prepared = diffuse.data();
    job.lit = inputs.diffuse.data();
    job.shaded = colours.data();
    job.first_block = 3;
    job.end_block = 5;
    best_lanes().of("LambertPrepared", false, false)(job);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const std::size_t block = i / (4 * kLaneBlock);
        EXPECT_EQ(colours[i] < 0.0f, block < 3 || block >= 5) << i;
    }
}

}  // namespace
}  // namespace livery
