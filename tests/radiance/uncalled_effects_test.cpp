// What a scene does not call for costs nothing: for every effect, a scene that calls for all others
// is drawn as it is and with the effect struck out, so that nothing could call it. What OpenGL and
// Embree were asked for is counted at their calls.
#include <algorithm>
#include <functional>
#include <numbers>

#include <glm/geometric.hpp>

#include "appearance/measured/measured_paint.h"
#include "appearance/subsurface/translucent_paint.h"
#include "core/image_io.h"
#include "radiance/renderer_fixture.h"
#include "scene/artwork_coats.h"
#include "support/shading_devices.h"
#include "support/temporary_folder.h"
#include "tracing/ray_counters.h"

namespace livery {
namespace {

using UncalledEffects = Renderer;

LIVERY_ON_BOTH_DEVICES(UncalledEffects);

/// All that a picture cost, by name.
using Cost = std::vector<std::pair<std::string, std::uint64_t>>;

struct UncalledEffect {
    const char* name;
    /// The scene does not call for it then; numbers that only it would read are left.
    std::function<void(Scene&)> leave_out;
    /// Nothing of it is left.
    std::function<void(Scene&)> strike;
    std::vector<PassKind> passes;  ///< that are its own
    Quality quality = Quality::normal;
    /// Where it costs anything that is counted, and not instructions alone.
    enum class Counted { everywhere, in_opengl, nowhere } counted = Counted::everywhere;
};

PartArtwork waves(const std::filesystem::path& file) {
    ImageF image(64, 64, 3);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const double phase = 2.0 * std::numbers::pi * (x + 0.5) / 32.0;
            const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3 * std::cos(phase), 0.0, 1.0));
            for (int c = 0; c < 3; ++c) {
                image.at(x, y, c) = static_cast<float>(0.5 + 0.5 * normal[c]);
            }
        }
    }
    write_exr(file, image);
    Artwork artwork;
    artwork.shape = ArtworkShape::picture;
    artwork.use = PictureUse::relief;
    artwork.picture = file.string();
    artwork.repeat = true;
    artwork.size_mm = 40.0;
    return make_part_artwork(0, artwork, {}, load_artwork_picture(file));
}

/// A scene that calls for all effects.
Scene everything(const PartArtwork& relief) {
    Material body = paint_of(ReflectanceModel::car_paint, 0.03);
    body.film_nm = 320.0;
    body.glint_density_per_mm2 = 5.0;
    Material wheels;
    wheels.model = ReflectanceModel::measured;
    wheels.measured = blank_measured_paint();
    Mesh mesh = two_spheres();
    append(mesh, make_sphere({-34, 40, 30}, 10.0, 48, "lens"), "");
    Scene scene = scene_of(std::move(mesh), body);
    scene.part_materials[1] = wheels;
    scene.part_materials[2] = translucent_paint(read_translucent_material("marble"));
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05), light_from({-0.5, 0.8, 0.6}, 0.05, 0.4)};
    scene.environment = studio();
    PartArtwork artwork;
    artwork.part = 1;
    artwork.material = paint_of(ReflectanceModel::clearcoat, 0.1);
    scene.artwork = {artwork};
    scene.relief = {relief};
    return scene;
}

void make_plain(Scene& scene, const Material& paint) {
    for (Material& one : scene.part_materials) one = paint;
    for (PartArtwork& artwork : scene.artwork) artwork.material = paint;
}

void dim(Scene& scene) {
    auto dark = std::make_shared<Environment>(*scene.environment);
    dark->scale = 0.0;
    scene.environment = dark;
}

Material without_gloss(Material paint) {
    paint.model = ReflectanceModel::lambert;
    return paint;
}

std::vector<UncalledEffect> effects() {
    using enum PassKind;
    const auto no_environment = [](Scene& scene) { scene.environment = nullptr; };
    const auto no_relief = [](Scene& scene) { scene.relief.clear(); };
    const auto no_artwork = [](Scene& scene) { scene.artwork.clear(); };
    return {
        {"lights and shadows",
         [](Scene& scene) {
             for (DirectionalLight& light : scene.lights) light.radiance_rec709 = glm::dvec3(0.0);
         },
         [](Scene& scene) { scene.lights.clear(); },
         {light_visibility, glint_places}},
        {"environment",
         dim,
         no_environment,
         {environment_irradiance,
          ambient_occlusion,
          environment_filter,
          reflection_occlusion,
          mirrored_environment}},
        {"occlusion", dim, no_environment, {ambient_occlusion}},
        {"mirrored environment",
         [](Scene& scene) { make_plain(scene, without_gloss(scene.part_materials[0])); },
         [](Scene& scene) {
             Material plain;
             plain.diffuse = scene.part_materials[0].diffuse;
             make_plain(scene, plain);
         },
         {environment_filter, reflection_occlusion, mirrored_environment, glint_places}},
        {"reflection occlusion",
         [](Scene&) {},
         [](Scene&) {},
         {reflection_occlusion},
         Quality::draft},
        {"glints",
         [](Scene& scene) {
             scene.part_materials[0].glint_density_per_mm2 = 0.0;
             scene.part_materials[0].glint_scale = 4.0;
         },
         [](Scene& scene) { scene.part_materials[0].glint_density_per_mm2 = 0.0; },
         {glint_places}},
        {"film",
         [](Scene& scene) {
             scene.part_materials[0].film_nm = 0.0;
             scene.part_materials[0].film_eta = 1.8;
         },
         [](Scene& scene) { scene.part_materials[0].film_nm = 0.0; },
         {},
         Quality::normal,
         UncalledEffect::Counted::nowhere},
        {"relief", no_relief, no_relief, {relief}},
        {"subsurface",
         [](Scene& scene) { scene.part_materials[2].model = ReflectanceModel::ggx; },
         [](Scene& scene) {
             scene.part_materials[2].model = ReflectanceModel::ggx;
             scene.part_materials[2].medium.reset();
         },
         {subsurface}},
        {"artwork", no_artwork, no_artwork, {artwork}},
        {"measured paints",
         [](Scene& scene) {
             const Material body = scene.part_materials[0];
             scene.part_materials[1] = body;
             scene.part_materials[1].measured = blank_measured_paint();
         },
         [](Scene& scene) { scene.part_materials[1] = scene.part_materials[0]; },
         {},
         Quality::normal,
         UncalledEffect::Counted::in_opengl},
    };
}

Cost cost_of(const Scene& scene, FramePlan plan, const std::vector<PassKind>& struck) {
    // What the plan does not list cannot be called
    std::erase_if(plan.passes, [&](const PlannedPass& pass) {
        return std::find(struck.begin(), struck.end(), pass.id.kind) != struck.end();
    });
    const RayCounters rays_before = ray_counters();
    RadianceRenderer renderer(
        std::make_shared<const FrameGeometry>(scene.product, test_view(48, 36)),
        false,
        UncalledEffects::GetParam());
    renderer.render(scene, plan);
    const RayCounters rays = ray_counters() - rays_before;
    const RadianceRenderer::Counters c = renderer.counters();
    const bool mirrors = find_pass(plan, PassKind::mirrored_environment) != nullptr;
    std::uint64_t layers = 0;
    for (const MirrorLayers& of_part : renderer.mirrored().of_part) layers += of_part.count();
    return {{"passes", static_cast<std::uint64_t>(c.passes_run)},
            {"fragments", static_cast<std::uint64_t>(c.fragments_shaded)},
            {"textures or arrays", static_cast<std::uint64_t>(c.textures)},
            {"programs", c.gl.programs},
            {"shader bytes", c.gl.shader_bytes},
            {"texture bytes", c.gl.texture_bytes},
            {"buffers", c.gl.buffers},
            {"buffer bytes", c.gl.buffer_bytes},
            {"framebuffers", c.gl.framebuffers},
            {"uploaded bytes", c.gl.upload_bytes},
            {"draws", c.gl.draws},
            {"dispatches", c.gl.dispatches},
            {"rays to what is met first", rays.closest},
            {"rays to what is in the way", rays.occluded},
            {"mirrored layers", mirrors ? layers : 0}};
}

TEST_P(UncalledEffects, CostNoMoreThanIfThereWereNone) {
    const TemporaryFolder folder;
    const Scene with_all = everything(waves(folder / "waves.exr"));
    const Cost all = cost_of(with_all, plan(with_all), {});
    for (const UncalledEffect& effect : effects()) {
        SCOPED_TRACE(effect.name);
        Scene without = with_all;
        effect.leave_out(without);
        Scene struck = without;
        effect.strike(struck);
        const Cost cost = cost_of(without, plan(without, effect.quality), {});
        const Cost least = cost_of(struck, plan(struck, effect.quality), effect.passes);
        bool noticed = false;
        for (std::size_t k = 0; k < cost.size(); ++k) {
            EXPECT_LE(cost[k].second, least[k].second) << cost[k].first;
            noticed = noticed || all[k].second > cost[k].second;
        }
        // What the effect does cost is among what is counted
        EXPECT_EQ(noticed,
                  effect.counted == UncalledEffect::Counted::everywhere ||
                      (effect.counted == UncalledEffect::Counted::in_opengl && in_opengl()));
    }
}

TEST_P(UncalledEffects, PointsAtInfinityTakeNoSoftShadowsRays) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.5));
    const auto rays_at = [&](Quality quality) {
        const Cost cost = cost_of(scene, plan(scene, quality), {});
        const auto rays = std::find_if(cost.begin(), cost.end(), [](const auto& one) {
            return one.first == "rays to what is in the way";
        });
        return rays->second;
    };
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.0)};
    const std::uint64_t point = rays_at(Quality::normal);
    EXPECT_EQ(rays_at(Quality::high), point);
    scene.lights = {light_from({0.5, 0.8, 0.6}, 0.05)};
    EXPECT_GT(rays_at(Quality::normal), 3 * point);
    EXPECT_GT(rays_at(Quality::high), 12 * point);
}

TEST_P(UncalledEffects, LayersOfLobesThatNobodyWearsAreNotMade) {
    // Textures of the packed fragments' size, four half floats a texel: each roughness reads four
    // lobes and one or two of what grazes.
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::ggx, 0.24));
    scene.environment = studio();
    RadianceRenderer renderer = renderer_of(scene, test_view(48, 36));
    FramePlan its_plan = plan(scene);
    renderer.render(scene, its_plan);
    const auto before = renderer.counters();
    const auto size = [&] { return mirror_layers_of(scene, MirrorMixing::cubic)[0].count(); };
    const std::size_t worn = size();
    EXPECT_LT(worn, 8u);
    scene.part_materials[0].alpha = glm::dvec2(0.02);
    FramePlan next = plan(scene);
    renderer.render(scene, next);
    const auto grown = renderer.counters();
    EXPECT_EQ(grown.textures - before.textures, 1) << "one that has room for more";
    if (!in_opengl()) return;
    const std::size_t layer =
        8u * kPackedWidth * static_cast<std::size_t>(layout_of(renderer.surface_map()).rows);
    EXPECT_EQ(grown.gl.texture_bytes - before.gl.texture_bytes, layer * (worn + size()));
}

}  // namespace
}  // namespace livery
