// What is mirrored is solved for the parts that mirror, at the roughnesses worn, and added to.
#include <cmath>

#include "appearance/model_table.h"
#include "radiance/light/mirror_quadrature.h"
#include "radiance/renderer_fixture.h"
#include "support/shading_devices.h"
#include "tracing/ray_counters.h"

namespace livery {
namespace {

using MirrorInputs = Renderer;

LIVERY_ON_DEVICES(MirrorInputs, ShadingDevice::processor, ShadingDevice::gl);

/// Half floats in three places, 2^-11 each.
void expect_same(const ImageF& one, const ImageF& other) {
    ASSERT_EQ(one.values.size(), other.values.size());
    for (std::size_t i = 0; i < one.values.size(); ++i) {
        ASSERT_NEAR(one.values[i], other.values[i], 1e-3f * (1e-3f + std::abs(one.values[i]))) << i;
    }
}

Scene lit_by_the_studio(const Material& body, const Material& wheels) {
    Scene scene = scene_of(two_spheres(), body);
    scene.part_materials[1] = wheels;
    scene.environment = studio();
    return scene;
}

/// Paints of narrow, middle and wide lobes, of each number of them.
std::vector<Material> paints() {
    std::vector<Material> all;
    for (const double alpha : {0.004, 0.05, 0.3, 0.8}) {
        all.push_back(paint_of(ReflectanceModel::ggx, alpha));
        all.push_back(paint_of(ReflectanceModel::clearcoat, alpha));
    }
    all.push_back(paint_of(ReflectanceModel::ward_duer, 0.13));
    all.push_back(paint_of(ReflectanceModel::car_paint, 0.02));
    all.push_back(paint_of(ReflectanceModel::lambert, 0.5));
    return all;
}

TEST_P(MirrorInputs, TheWornRoughnessesLookAsIfAllWereSolved) {
    const View view = test_view(48, 36);
    for (const Quality quality : {Quality::draft, Quality::normal}) {
        Scene scene = lit_by_the_studio(paint_of(ReflectanceModel::lambert, 0.5), {});
        RadianceRenderer all = renderer_of(scene, view);
        FramePlan ahead = plan(scene, quality);
        plan_ahead(ahead);
        all.prepare(scene, ahead);
        for (const MirrorLayers& of_part : all.mirrored().of_part) EXPECT_TRUE(of_part.all());
        for (const Material& paint : paints()) {
            SCOPED_TRACE(::testing::Message() << model_info(paint.model).name << " "
                                              << paint.alpha.x << " " << to_string(quality));
            scene.part_materials[0] = paint;
            FramePlan its_plan = plan(scene, quality);
            all.render(scene, its_plan);
            for (const PassKind kind :
                 {PassKind::reflection_occlusion, PassKind::mirrored_environment}) {
                const PlannedPass* pass = find_pass(its_plan, kind);
                EXPECT_TRUE(!pass || *pass->ms == 0.0) << to_string(kind);
            }
            expect_same(draw(scene, view, quality), all.read_back());
        }
    }
}

TEST_P(MirrorInputs, ADragBeginsWithWhatWasFilteredAhead) {
    const View view = test_view(48, 36);
    Scene scene = lit_by_the_studio(paint_of(ReflectanceModel::ggx, 0.2), {});
    RadianceRenderer renderer = renderer_of(scene, view);
    FramePlan ahead = plan(scene, Quality::normal);
    plan_ahead(ahead);
    renderer.prepare(scene, ahead);
    const auto expect_no_filter = [&] {
        FramePlan draft = plan(scene, Quality::draft);
        renderer.render(scene, draft);
        EXPECT_EQ(*find_pass(draft, PassKind::environment_filter)->ms, 0.0);
        EXPECT_GT(*find_pass(draft, PassKind::mirrored_environment)->ms, 0.0);
    };
    scene.eye_in_world_mm.x += 100.0;
    expect_no_filter();
    auto turned = std::make_shared<Environment>(*scene.environment);
    turned->rotation_rad += 0.1;
    scene.environment = std::move(turned);
    expect_no_filter();
    // Once it is there, nothing is done for it again
    FramePlan again = plan(scene, Quality::draft);
    plan_ahead(again);
    renderer.prepare(scene, again);
    renderer.prepare(scene, again);
    EXPECT_EQ(*find_pass(again, mirrored_ahead_pass())->ms, 0.0);
}

// What a paint sends to other parts is mirrored by them. A paint that comes then wears lobes that
// were solved before that, and is to be seen at once.
TEST_P(MirrorInputs, APaintWaitsForNoLightBetweenParts) {
    const View view = test_view(48, 36);
    Scene scene = lit_by_the_studio(paint_of(ReflectanceModel::ggx, 0.2),
                                    paint_of(ReflectanceModel::ggx, 0.2));
    RadianceRenderer renderer = renderer_of(scene, view);
    const auto planned = [&] { return plan_frame(scene, Quality::high, FrameStage::radiance); };
    FramePlan ahead = planned();
    ASSERT_NE(find_pass(ahead, PassKind::interreflection), nullptr);
    plan_ahead(ahead);
    renderer.prepare(scene, ahead);
    const auto solved = [&](const Material& paint, LightBetweenParts between) {
        scene.part_materials[0] = paint;
        FramePlan its_plan = planned();
        renderer.render(scene, its_plan, {}, between);
        double ms = 0.0;
        for (const PassKind kind : {PassKind::interreflection,
                                    PassKind::reflection_occlusion,
                                    PassKind::mirrored_environment}) {
            ms += *find_pass(its_plan, kind)->ms;
        }
        return ms;
    };
    EXPECT_GT(solved(paint_of(ReflectanceModel::ggx, 0.03), LightBetweenParts::solved), 0.0);
    Material coated = paint_of(ReflectanceModel::clearcoat, 0.5);
    coated.diffuse = glm::dvec3(0.05);
    EXPECT_EQ(solved(coated, LightBetweenParts::kept), 0.0);
    EXPECT_GT(solved(coated, LightBetweenParts::solved), 0.0);
    EXPECT_EQ(solved(coated, LightBetweenParts::solved), 0.0);
}

// A lamp that is dragged changes what parts send into one another's mirrors, and a paint that comes
// meanwhile may have other lobes: neither may take the seconds that a finished picture takes.
TEST_P(MirrorInputs, ADraftWaitsForNoMirror) {
    const View view = test_view(48, 36);
    Scene scene = lit_by_the_studio(paint_of(ReflectanceModel::ggx, 0.2),
                                    paint_of(ReflectanceModel::ggx, 0.2));
    scene.lights = {light_from({0.4, 0.8, 0.5}, 0.05)};
    const auto new_renderer = [&] {
        return RadianceRenderer(
            std::make_shared<const FrameGeometry>(scene.product, view), true, GetParam());
    };
    RadianceRenderer renderer = new_renderer();
    const auto render_with = [&](RadianceRenderer& with, Quality quality) {
        FramePlan its_plan = plan_frame(scene, quality, FrameStage::radiance);
        with.render(scene, its_plan);
        return its_plan;
    };
    const auto render = [&](Quality quality) { return render_with(renderer, quality); };
    ASSERT_NE(find_pass(render(Quality::normal), PassKind::interreflection), nullptr);
    scene.lights = {light_from({0.6, 0.7, 0.5}, 0.05)};
    EXPECT_EQ(*find_pass(render(Quality::draft), PassKind::mirrored_environment)->ms, 0.0);
    EXPECT_EQ(renderer.mirrored().mixing, MirrorMixing::cubic);
    scene.part_materials[0] = paint_of(ReflectanceModel::ggx, 0.025);
    const RayCounters before = ray_counters();
    render(Quality::draft);
    EXPECT_EQ(renderer.mirrored().mixing, MirrorMixing::linear);
    EXPECT_EQ(ray_counters() - before, RayCounters());
    // And nothing of it stays
    render(Quality::normal);
    RadianceRenderer anew = new_renderer();
    render_with(anew, Quality::normal);
    expect_same(anew.read_back(), renderer.read_back());
}

TEST_P(MirrorInputs, OnlyWhatIsReadIsSolved) {
    const Scene scene = lit_by_the_studio(paint_of(ReflectanceModel::lambert, 0.5),
                                          paint_of(ReflectanceModel::ggx, 0.2));
    RadianceRenderer renderer = renderer_of(scene, test_view(64, 48));
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    EXPECT_TRUE(renderer.mirrored().of_part[0].none());
    // Lobes of .12 to .34; what grazes of .17 and of .24
    EXPECT_EQ(renderer.mirrored().of_part[1].to_string(), "011000111100000000");
    const auto& begin = renderer.surface_map().part_begin;
    EXPECT_EQ(find_pass(its_plan, PassKind::reflection_occlusion)->work_items,
              mirror_rays(16) * static_cast<double>(begin[2] - begin[1]));
}

TEST_P(MirrorInputs, ALobeThatReflectsNothingAsksForNothing) {
    // A solid paint under varnish of its binder's index: how rough it is there nobody can see.
    const View view = test_view(64, 48);
    Material solid = paint_of(ReflectanceModel::clearcoat, 0.4);
    solid.f0 = glm::dvec3(0.0);
    Scene scene = lit_by_the_studio(solid, paint_of(ReflectanceModel::lambert, 0.5));
    const MirrorLayers layers = mirror_layers_of(solid, MirrorMixing::cubic);
    const ImageF rough = draw(scene, view);
    scene.part_materials[0].alpha = glm::dvec2(0.05);
    EXPECT_EQ(mirror_layers_of(scene.part_materials[0], MirrorMixing::cubic), layers);
    expect_same(draw(scene, view), rough);
    scene.part_materials[0].f0 = glm::dvec3(0.04);
    EXPECT_GT(mirror_layers_of(scene.part_materials[0], MirrorMixing::cubic).count(),
              layers.count());
}

TEST_P(MirrorInputs, ASwapAddsWhatIsMissing) {
    const View view = test_view(64, 48);
    Scene scene = lit_by_the_studio(paint_of(ReflectanceModel::lambert, 0.5),
                                    paint_of(ReflectanceModel::ggx, 0.2));
    RadianceRenderer renderer = renderer_of(scene, view);
    for (std::size_t k = 0; k < paints().size(); k += 2) {
        scene.part_materials[k / 2 % 2] = paints()[k];
        FramePlan its_plan = plan(scene);
        renderer.render(scene, its_plan);
        expect_same(draw(scene, view), renderer.read_back());
    }
    // What was worn once is there still
    scene.part_materials[0] = paints()[0];
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    EXPECT_EQ(*find_pass(its_plan, PassKind::mirrored_environment)->ms, 0.0);
    // Another eye begins anew, with what is worn
    scene.eye_in_world_mm.x += 60.0;
    its_plan = plan(scene);
    renderer.render(scene, its_plan);
    EXPECT_EQ(renderer.mirrored().of_part, mirror_layers_of(scene, MirrorMixing::cubic));
    expect_same(draw(scene, view), renderer.read_back());
}

TEST_P(MirrorInputs, ArtworkMirrorsToo) {
    const View view = test_view(64, 48);
    Scene scene = lit_by_the_studio(paint_of(ReflectanceModel::lambert, 0.5),
                                    paint_of(ReflectanceModel::lambert, 0.5));
    PartArtwork artwork;
    artwork.part = 1;
    artwork.material = paint_of(ReflectanceModel::clearcoat, 0.05);
    scene.artwork = {artwork};
    const std::vector<MirrorLayers> layers = mirror_layers_of(scene, MirrorMixing::cubic);
    EXPECT_TRUE(layers[0].none());
    EXPECT_EQ(layers[1], mirror_layers_of(artwork.material, MirrorMixing::cubic));
    RadianceRenderer renderer = renderer_of(scene, view);
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    EXPECT_EQ(renderer.mirrored().of_part, layers);
}

}  // namespace
}  // namespace livery
