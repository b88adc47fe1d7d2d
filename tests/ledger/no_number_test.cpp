// One number that is none, at each stage of what is drawn: it ends black on the projector and
// counted, in OpenGL as on the processor, and its neighbours are as they were.
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "appearance/model_table.h"
#include "compensation/compensation.h"
#include "compensation/gpu_pass.h"
#include "compensation/synthetic.h"
#include "gl/context.h"
#include "gl/read_back.h"
#include "ledger/drawn_errors.h"
#include "radiance/shading.h"
#include "support/gl_device.h"

namespace livery {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kFragments = 64, kSpoiled = 27;
constexpr double kAlpha = 0.1;

/// Several of them lit by all that there is.
LooseFragments fragments_of(ReflectanceModel model, bool glints) {
    Random random(7);
    LooseFragments all = drawn_fragments(DrawnLight::disc_relief, kAlpha, kFragments, random);
    LooseFragments sky = drawn_fragments(DrawnLight::environment, kAlpha, kFragments, random);
    all.sky = sky.sky;
    all.mirror = sky.mirror;
    all.lit = sky.sky;
    for (glm::vec4& light : all.lights[0]) light.w = 1.0f;
    if (glints) {
        all.places = drawn_fragments(DrawnLight::glints, kAlpha, kFragments, random).places;
    }
    if (model == ReflectanceModel::lambert) all.lights.clear();
    return all;
}

Material paint(ReflectanceModel model, bool glints) {
    Material material;
    material.model = model;
    material.alpha = glm::dvec2(kAlpha);
    material.exponent = glm::dvec2(200.0);
    if (model == ReflectanceModel::measured) material.measured = blank_measured_paint();
    if (glints) material.glint_density_per_mm2 = 150.0;
    return material;
}

/// What a projector is sent for them, each a pixel, and what was counted.
struct OnTheProjector {
    Image8 drive;
    CompensationStats stats;
};

class NoNumber : public ::testing::Test {
  protected:
    HeadlessContext context_{tested_gl()};
    synthetic::World world_ = synthetic::make_world(kFragments, 1, 31);
    CompensationTable table_ = bake(synthetic::calibrate(world_), 0.4);
    CompensationTable mapped_ = bake(synthetic::calibrate(world_), 0.4, GamutMapping::preserve);

    static ImageF picture_of(const std::vector<glm::vec3>& colours) {
        ImageF picture(kFragments, 1, 4, 1.0f);
        for (std::size_t i = 0; i < colours.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                picture.values[4 * i + static_cast<std::size_t>(c)] = colours[i][c];
            }
        }
        return picture;
    }

    OnTheProjector sent(const ImageF& radiance, const CompensationTable& table, bool in_gl) {
        OnTheProjector result;
        if (!in_gl) {
            result.drive = compensate(table, radiance, &result.stats);
            return result;
        }
        Texture2D wanted(kFragments, 1, TexelFormat::rgba16f);
        wanted.upload(radiance.values);
        Texture2D drive(kFragments, 1, TexelFormat::rgba8);
        GpuCompensation pass(table);
        CompensationCounts counts;
        pass.run(wanted.name(), drive, counts);
        result.drive = read_bytes(drive, 3);
        result.stats = counts.read(count_covered(radiance));
        return result;
    }

    /// Of `spoiled`, one pixel is black and counted in both kinds of correction, the others as
    /// those of `good`.
    void expect_black_and_counted(const ImageF& good, const ImageF& spoiled, bool in_gl) {
        for (const CompensationTable* table : {&table_, &mapped_}) {
            const OnTheProjector before = sent(good, *table, in_gl);
            const OnTheProjector after = sent(spoiled, *table, in_gl);
            EXPECT_EQ(before.stats.invalid_fraction, 0.0);
            EXPECT_DOUBLE_EQ(after.stats.invalid_fraction, 1.0 / kFragments);
            for (std::size_t i = 0; i < after.drive.values.size(); ++i) {
                const bool here = i / 3 == kSpoiled;
                ASSERT_EQ(after.drive.values[i], here ? 0 : before.drive.values[i]) << i;
            }
        }
    }
};

using Spoil = std::function<void(LooseFragments&)>;

std::vector<std::pair<std::string, Spoil>> spoils(const Material& material) {
    const ReflectanceModel model = material.model;
    const bool glints = has_glints(material);
    std::vector<std::pair<std::string, Spoil>> all;
    if (model == ReflectanceModel::lambert) {
        return {{"light", [](LooseFragments& f) { f.lit[kSpoiled].y = kNan; }}};
    }
    for (int c = 0; c < 4; ++c) {
        all.push_back(
            {"eye " + std::to_string(c), [c](LooseFragments& f) { f.eye[kSpoiled][c] = kNan; }});
        all.push_back({"light " + std::to_string(c),
                       [c](LooseFragments& f) { f.lights[0][kSpoiled][c] = kNan; }});
        if (!glints) continue;
        all.push_back({"place " + std::to_string(c),
                       [c](LooseFragments& f) { f.places[kSpoiled][c] = kNan; }});
    }
    all.push_back({"sky", [](LooseFragments& f) { f.sky[kSpoiled].x = kNan; }});
    const ModelInfo& info = model_info(model);
    if (!info.mirrors()) return all;
    constexpr MirrorMixing kCubic = MirrorMixing::cubic;
    const glm::vec4 read = has_own_shading(model)
                               ? uniforms_of(material, 0.0, kCubic).lobe_layers[0]
                               : any_model_uniforms_of(material, 0.0, kCubic).base_layers;
    // One that is read: the others may be absent
    const auto lobe = static_cast<std::size_t>(read.x) + (read.y != 0.0f   ? 1u
                                                          : read.z != 0.0f ? 2u
                                                          : read.w != 0.0f ? 3u
                                                                           : 0u);
    all.push_back({"mirror", [lobe](LooseFragments& f) { f.mirror[lobe][kSpoiled].z = kNan; }});
    if (!has_own_shading(model)) return all;
    for (std::size_t k = kMirrorAlphas.size(); k < kMirrorLayers; ++k) {
        all.push_back({"grazing " + std::to_string(k),
                       [k](LooseFragments& f) { f.mirror[k][kSpoiled].y = kNan; }});
    }
    return all;
}

TEST_F(NoNumber, InWhatAFragmentReadsEndsBlackAndCounted) {
    std::vector<std::pair<ReflectanceModel, bool>> paints;
    for (const ModelInfo& info : formula_models()) paints.push_back({info.model, false});
    paints.push_back({ReflectanceModel::measured, false});
    paints.push_back({ReflectanceModel::car_paint, true});
    for (const auto& [model, glints] : paints) {
        const Material material = paint(model, glints);
        const LooseFragments good = fragments_of(model, glints);
        const ImageF of_gl = picture_of(shaded_in_gl(material, good, -4.0));
        const ImageF of_lanes = picture_of(shaded_in_lanes(material, good, -4.0));
        for (const auto& [name, spoil] : spoils(material)) {
            SCOPED_TRACE(::testing::Message() << model_info(model).name << ": " << name);
            LooseFragments spoiled = good;
            spoil(spoiled);
            expect_black_and_counted(
                of_gl, picture_of(shaded_in_gl(material, spoiled, -4.0)), true);
            for (std::size_t k = 0; k < lanes_available(); ++k) {
                const auto lanes = shaded_in_lanes(material, spoiled, -4.0, lanes_available(k));
                expect_black_and_counted(of_lanes, picture_of(lanes), false);
            }
            if (HasFailure()) return;
        }
    }
}

TEST_F(NoNumber, InAUniformEndsBlackAndCountedEverywhere) {
    const std::pair<const char*, Spoil> of_light[] = {
        {"irradiance", [](LooseFragments& f) { f.light_irradiance[0].x = kNan; }},
        {"size", [](LooseFragments& f) { f.light_radius2[0] = kNan; }},
        {"unit of what is mirrored", [](LooseFragments& f) { f.mirror_unit = kNan; }}};
    for (const ReflectanceModel model : {ReflectanceModel::ggx,
                                         ReflectanceModel::clearcoat,
                                         ReflectanceModel::car_paint,
                                         ReflectanceModel::ward_1992,
                                         ReflectanceModel::ashikhmin_shirley}) {
        const Material material = paint(model, false);
        const auto expect_black = [&](const LooseFragments& fragments, double exposure_ev) {
            for (const bool in_gl : {false, true}) {
                const ImageF picture =
                    picture_of(in_gl ? shaded_in_gl(material, fragments, exposure_ev)
                                     : shaded_in_lanes(material, fragments, exposure_ev));
                const OnTheProjector result = sent(picture, table_, in_gl);
                EXPECT_EQ(result.stats.invalid_fraction, 1.0) << in_gl;
                for (const std::uint8_t level : result.drive.values) ASSERT_EQ(level, 0) << in_gl;
            }
        };
        for (const auto& [name, spoil] : of_light) {
            SCOPED_TRACE(::testing::Message() << model_info(model).name << ": " << name);
            LooseFragments spoiled = fragments_of(model, false);
            spoil(spoiled);
            expect_black(spoiled, -4.0);
        }
        SCOPED_TRACE(::testing::Message() << model_info(model).name << ": exposure");
        expect_black(fragments_of(model, false), std::nan(""));
    }
}

TEST_F(NoNumber, InAPaintIsRefusedOrTakesTheExposureWithIt) {
    Material material = paint(ReflectanceModel::ggx, false);
    material.alpha.x = std::nan("");
    EXPECT_THROW(uniforms_of(material, 0.0, MirrorMixing::cubic), std::invalid_argument);
    // What a model might make of sound parameters
    const std::vector<float> sound{0.5f, 1.0f}, spoiled{0.5f, kNan, 1.0f};
    EXPECT_EQ(exposure_of(1.0, sound), 2.0f);
    EXPECT_TRUE(std::isnan(exposure_of(1.0, spoiled)));
}

TEST_F(NoNumber, InTheRadianceTextureEndsBlackAndCounted) {
    const Material material = paint(ReflectanceModel::car_paint, false);
    const LooseFragments fragments = fragments_of(ReflectanceModel::car_paint, false);
    const ImageF good = picture_of(shaded_in_lanes(material, fragments, -4.0));
    for (const float bad :
         {kNan, -kNan, std::bit_cast<float>(0x7f800001u), std::bit_cast<float>(0xffffffffu)}) {
        for (std::size_t c = 0; c < 3; ++c) {
            ImageF spoiled = good;
            spoiled.values[4 * kSpoiled + c] = bad;
            expect_black_and_counted(good, spoiled, false);
            expect_black_and_counted(good, spoiled, true);
        }
    }
}

}  // namespace
}  // namespace livery
