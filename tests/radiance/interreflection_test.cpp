#include "radiance/light/interreflection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "appearance/paint_bsdf.h"
#include "gl/context.h"
#include "radiance/renderer.h"
#include "reference/path_tracer.h"
#include "support/shading_devices.h"
#include "support/small_meshes.h"
#include "tracing/ray_counters.h"

namespace livery {
namespace {

Scene white_scene(Mesh mesh, double albedo) {
    auto product = std::make_shared<Product>();
    product->mesh = std::move(mesh);
    product->exchange = part_exchange(product->mesh);
    Scene scene;
    scene.part_materials.resize(product->mesh.parts.size());
    for (Material& paint : scene.part_materials) paint.diffuse = glm::dvec3(albedo);
    scene.product = std::move(product);
    return scene;
}

/// Where light on a white diffuser ends up, all bounces followed.
struct Solved {
    NodeExchange exchange;
    std::vector<glm::vec3> direct, exchanged;  ///< on a diffuser
};
Solved solve(const Scene& scene, int bounces) {
    const Tracer tracer(scene.product->mesh);
    Solved solved;
    solved.exchange = solve_node_exchange(scene.product->mesh, tracer);
    FilteredEnvironment filtered;
    if (scene.environment)
        filtered = filter_environment(*scene.environment, {false, true, true, false});
    const NodeReflectance reflectance =
        reflectance_at_nodes(scene, solved.exchange.nodes, solved.exchange.directions);
    DirectLight direct = direct_light_at_nodes(scene.product->mesh,
                                               tracer,
                                               solved.exchange,
                                               scene.lights,
                                               scene.environment.get(),
                                               filtered,
                                               reflectance.lobes);
    solved.exchanged =
        exchanged_at_nodes(solved.exchange, direct, reflectance, bounces).on_diffuser;
    solved.direct = std::move(direct.on_diffuser);
    return solved;
}

TEST(Radiosity, AWhiteBoxUnderEvenLightVanishes) {
    Scene scene = white_scene(open_box(), 1.0);
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(32, 16, 3, 1.0f);
    scene.environment = environment;
    const Solved solved = solve(scene, 1000);
    std::size_t dim = 0;
    for (std::size_t i = 0; i < solved.direct.size(); ++i) {
        EXPECT_NEAR(solved.direct[i].y + solved.exchanged[i].y, 1.0f, 0.02f) << i;
        dim += solved.direct[i].y < 0.6f ? 1u : 0u;
    }
    EXPECT_GT(dim, 100u);  // what direct light alone leaves dark
}

TEST(Radiosity, OfAGrooveIsTheClosedForm) {
    // A right-angled groove of albedo .5 lit straight into it, at .016, .525 and .907 of a side; by
    // solving the integral equation on a fine grid. Light on a diffuser: all less what comes
    // direct.
    const Solved solved = solve(
        [] {
            Scene scene = white_scene(groove(1.0f, 6.0f), 0.5);
            DirectionalLight light;
            light.direction = {0.0, 1.0, 0.0};
            light.angle_rad = 0.0;
            scene.lights = {light};
            return scene;
        }(),
        16);
    const double direct = std::sqrt(0.5);
    struct Place {
        double at, radiance;
    };
    for (const Place& place : {Place{0.525, 0.40893}, Place{0.907, 0.38702}}) {
        double sum = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < solved.direct.size(); ++i) {
            const glm::vec3 p = solved.exchange.nodes.position_mm(i);
            const double at = std::hypot(static_cast<double>(p.x), static_cast<double>(p.y));
            if (std::abs(p.z) > 1.0f || std::abs(at - place.at) > 0.05) continue;
            sum += static_cast<double>(solved.exchanged[i].y);
            ++count;
        }
        ASSERT_GT(count, 20);
        // 20 nodes and more of 64 rays each: 2%; the grid reaches .05 to both sides: 3%
        const double expected = place.radiance / 0.5 - direct;
        EXPECT_NEAR(sum / count, expected, 0.05 * expected) << place.at;
    }
}

TEST(NodeReflectance, ALobeSendsAsMuchAsItReturnsAndMostOfItWhereItMirrors) {
    const NodeDirections directions(64);
    Material mirror;
    mirror.model = ReflectanceModel::ggx;
    mirror.diffuse = glm::dvec3(0.0);
    mirror.f0 = {0.9, 0.6, 0.3};
    for (const double alpha : {0.02, 0.1, 0.3}) {
        mirror.alpha = glm::dvec2(alpha);
        const RayMatrix matrix(mirror, directions);
        std::vector<glm::vec3> comes(64, glm::vec3(1.0f)), sent(64);
        matrix.send(comes, sent);
        for (std::size_t k = 0; k < sent.size(); ++k) {
            const glm::vec3 of_one =
                environment_weights(bsdf_of(mirror), directions.directions()[k].z).specular;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(sent[k][c], of_one[c], 1e-3f) << alpha;
        }
        for (std::size_t from = 0; from < comes.size(); ++from) {
            std::fill(comes.begin(), comes.end(), glm::vec3(0.0f));
            comes[from] = glm::vec3(1.0f);
            matrix.send(comes, sent);
            const glm::vec3 in = directions.directions()[from];
            const auto brightest = std::max_element(
                sent.begin(), sent.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
            const glm::vec3 out =
                directions.directions()[static_cast<std::size_t>(brightest - sent.begin())];
            // Directions are .25 apart, twice that toward the horizon, where lobes lean besides
            if (in.z < 0.3f) continue;
            EXPECT_LT(glm::distance(out, glm::vec3(-in.x, -in.y, in.z)), 0.5f) << alpha;
        }
    }
}

TEST(NodeReflectance, ADiffuserSendsEvenly) {
    Scene scene = white_scene(open_box(), 0.7);
    const NodeExchange exchange =
        solve_node_exchange(scene.product->mesh, Tracer(scene.product->mesh));
    const NodeReflectance reflectance =
        reflectance_at_nodes(scene, exchange.nodes, exchange.directions);
    EXPECT_TRUE(reflectance.matrices.empty());
    EXPECT_EQ(dark_nodes(exchange.nodes, reflectance.lobes, exchange.rays()).values.size(),
              exchange.nodes.size());
}

TEST(NodeExchange, ARayTowardAPlaceIsTheOneThatIsSeenFromThere) {
    const Mesh mesh = open_box();
    const NodeExchange exchange = solve_node_exchange(mesh, Tracer(mesh));
    std::vector<glm::vec3> turned(exchange.rays());
    for (std::uint32_t i = 0; i < exchange.nodes.size(); i += 97) {
        exchange.directions_of(i, turned);
        const glm::vec3 n = exchange.nodes.normal(i);
        for (std::size_t k = 0; k < turned.size(); ++k) {
            EXPECT_GT(glm::dot(turned[k], n), 0.0f);
            EXPECT_EQ(exchange.ray_toward(i, turned[k], n),
                      ray_of_node(i, static_cast<std::uint8_t>(k)));
        }
    }
}

TEST(ExchangePoints, InterpolateLinearFunctionsExactly) {
    const Mesh mesh = groove(1.0f, 6.0f);
    const ExchangePoints points = exchange_nodes(mesh).points;
    EXPECT_GT(points.size(), 1000u);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const glm::vec2 at : {glm::vec2(0.0f),
                                   {1.0f, 0.0f},
                                   {0.0f, 1.0f},
                                   {0.31f, 0.42f},
                                   {0.5f, 0.5f},
                                   {0.9999f, 0.0001f},
                                   {0.013f, 0.97f}}) {
            const glm::uvec3 c = mesh.triangles[t];
            const glm::vec3 place = (1.0f - at.x - at.y) * mesh.positions_mm[c.x] +
                                    at.x * mesh.positions_mm[c.y] + at.y * mesh.positions_mm[c.z];
            glm::vec3 found(0.0f);
            for (const auto& share : points.around(mesh, t, at)) {
                EXPECT_GE(share.weight, -1e-5f);
                ASSERT_LT(share.index, points.size());
                found += share.weight * points.positions_mm[share.index];
            }
            EXPECT_LT(glm::distance(found, place), 1e-5f) << t << " " << at.x << " " << at.y;
        }
    }
}

class Interreflection : public ::testing::TestWithParam<ShadingDevice> {};

/// The mean radiance of the covered pixels at these levels.
double brightness(const Scene& scene,
                  const View& view,
                  const EffectLevels& levels,
                  ShadingDevice device) {
    const HeadlessContext context(GlDevice::automatic);
    RadianceRenderer renderer(
        std::make_shared<const FrameGeometry>(scene.product, view), false, device);
    FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
    renderer.render(scene, plan);
    const ImageF picture = renderer.read_back();
    double sum = 0.0, covered = 0.0;
    for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
        const float* v = picture.values.data() + 4 * i;
        sum += static_cast<double>(v[1] * v[3]);
        covered += static_cast<double>(v[3]);
    }
    return sum / covered;
}

TEST_P(Interreflection, BrightensAGrooveInLampsAndInAnEnvironment) {
    for (const ReflectanceModel model :
         {ReflectanceModel::lambert, ReflectanceModel::clearcoat, ReflectanceModel::eon}) {
        Scene scene = white_scene(groove(1.0f, 6.0f), 0.5);
        scene.eye_in_world_mm = {0.0, 20.0, 0.0};
        scene.part_materials[0].model = model;
        scene.part_materials[0].coat_f0 = 0.0;
        const View view = look_at(scene.eye_in_world_mm, {0.0, 0.5, 0.0}, 0.04, 32, 24);
        EffectLevels without = levels_of(Quality::normal);
        without[Effect::interreflection] = 0;
        const EffectLevels with = levels_of(Quality::high);
        const auto gain = [&] {
            return brightness(scene, view, with, GetParam()) /
                   brightness(scene, view, without, GetParam());
        };
        DirectionalLight light;
        light.direction = {0.0, 1.0, 0.0};
        light.angle_rad = 0.0;
        scene.lights = {light};
        // From .38 to .47 of .354: the mean over the seen part of the sides
        EXPECT_GT(gain(), 1.10) << static_cast<int>(model);
        EXPECT_LT(gain(), 1.30) << static_cast<int>(model);
        auto environment = std::make_shared<Environment>();
        environment->radiance_working = ImageF(32, 16, 3, 1.0f);
        scene.lights.clear();
        scene.environment = environment;
        EXPECT_GT(gain(), 1.10) << static_cast<int>(model);
        EXPECT_LT(gain(), 1.45) << static_cast<int>(model);
    }
}

TEST_P(Interreflection, CostsNothingWhereNothingFacesAnother) {
    const HeadlessContext context(GlDevice::automatic);
    Scene scene = white_scene(make_sphere({0, 0, 0}, 10.0, 24, "ball"), 0.8);
    scene.lights.emplace_back();
    scene.eye_in_world_mm = {0.0, 0.0, 60.0};
    const View view = look_at(scene.eye_in_world_mm, {0.0, 0.0, 0.0}, 0.4, 32, 24);
    EffectLevels struck = levels_of(Quality::high);
    struck[Effect::interreflection] = 0;
    struct Cost {
        RayCounters rays;
        int passes = 0;
    };
    const auto cost_of = [&](const EffectLevels& levels) {
        const RayCounters before = ray_counters();
        RadianceRenderer renderer(
            std::make_shared<const FrameGeometry>(scene.product, view), false, GetParam());
        FramePlan plan = plan_frame(scene, levels, FrameStage::radiance);
        EXPECT_EQ(find_pass(plan, PassKind::interreflection), nullptr);
        renderer.render(scene, plan);
        return Cost{ray_counters() - before, renderer.counters().passes_run};
    };
    const Cost whole = cost_of(levels_of(Quality::high)), least = cost_of(struck);
    EXPECT_EQ(whole.rays, least.rays);
    EXPECT_EQ(whole.passes, least.passes);
}

TEST_P(Interreflection, OfAnotherPaintIsKeptUntilItIsAskedFor) {
    const HeadlessContext context(GlDevice::automatic);
    Scene scene = white_scene(groove(1.0f, 6.0f), 0.8);
    scene.eye_in_world_mm = {0.0, 20.0, 0.0};
    DirectionalLight light;
    light.angle_rad = 0.0;
    scene.lights = {light};
    const View view = look_at(scene.eye_in_world_mm, {0.0, 0.5, 0.0}, 0.04, 32, 24);
    RadianceRenderer renderer(
        std::make_shared<const FrameGeometry>(scene.product, view), false, GetParam());
    const auto drawn = [&](LightBetweenParts between) {
        FramePlan plan = plan_frame(scene, Quality::high, FrameStage::radiance);
        renderer.render(scene, plan, {}, between);
        return renderer.read_back();
    };
    const ImageF bright = drawn(LightBetweenParts::solved);
    for (Material& paint : scene.part_materials) paint.diffuse = glm::dvec3(0.4);
    const ImageF kept = drawn(LightBetweenParts::kept);
    const ImageF solved = drawn(LightBetweenParts::solved);
    const std::size_t middle = 4 * (12 * 32 + 16) + 1;
    // Half the paint in the light of the old one, and then in that of its own
    EXPECT_NEAR(kept.values[middle], 0.5f * bright.values[middle], 2e-3f);
    EXPECT_LT(solved.values[middle], 0.95f * kept.values[middle]);
}

/// A level mirror between a red wall on the left and a blue one on the right.
Scene mirror_between_walls() {
    Mesh mesh;
    add_quad(mesh, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    add_quad(mesh, {-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1});
    add_quad(mesh, {1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1});
    mesh.parts = {{"mirror", "", glm::dvec3(0.5)},
                  {"left", "", glm::dvec3(0.5)},
                  {"right", "", glm::dvec3(0.5)}};
    mesh.triangle_part = {0, 0, 1, 1, 2, 2};
    Scene scene = white_scene(std::move(mesh), 0.5);
    scene.part_materials[0].model = ReflectanceModel::ggx;
    scene.part_materials[0].diffuse = glm::dvec3(0.0);
    scene.part_materials[0].f0 = glm::dvec3(1.0);
    scene.part_materials[0].alpha = glm::dvec2(0.05);
    scene.part_materials[1].diffuse = {0.6, 0.05, 0.05};
    scene.part_materials[2].diffuse = {0.05, 0.05, 0.6};
    auto environment = std::make_shared<Environment>();
    environment->radiance_working = ImageF(32, 16, 3, 1.0f);
    scene.environment = environment;
    return scene;
}

/// What the mirror shows of the red wall, and the wall itself where it is mirrored.
struct WallInMirror {
    glm::vec3 mirrored, wall;
};
WallInMirror wall_in_mirror(Scene scene, ShadingDevice device) {
    // From the right over the blue wall's edge, down onto the mirror: it shows the red wall
    scene.eye_in_world_mm = {6.0, 12.0, 0.0};
    const View view = look_at(scene.eye_in_world_mm, {-0.6, 0.0, 0.0}, 0.02, 16, 16);
    const View onto_wall = look_at(scene.eye_in_world_mm, {-1.0, 0.73, 0.0}, 0.02, 16, 16);
    const auto middle_of = [&](const View& seen) {
        RadianceRenderer renderer(
            std::make_shared<const FrameGeometry>(scene.product, seen), false, device);
        FramePlan plan = plan_frame(scene, dearest_levels(), FrameStage::radiance);
        renderer.render(scene, plan);
        const float* v = &renderer.read_back().values[4 * (8 * 16 + 8)];
        return glm::vec3(v[0], v[1], v[2]);
    };
    return {middle_of(view), middle_of(onto_wall)};
}

TEST_P(Interreflection, AMirrorShowsThePartThatItFaces) {
    const HeadlessContext context(GlDevice::automatic);
    const auto [mirrored, wall] = wall_in_mirror(mirror_between_walls(), GetParam());
    // At .4 from the wall the mirror shows it .4 * 12 / 6.6 up: as bright as there, within what
    // changes over the lobe and the node that stands for it
    EXPECT_NEAR(mirrored.x, wall.x, 0.15f * wall.x);
    EXPECT_GT(mirrored.x, 4.0f * mirrored.z) << "the blue wall shines in from behind";
}

TEST_P(Interreflection, AMirrorShowsWhatALampLightsWhereNoEnvironmentIs) {
    const HeadlessContext context(GlDevice::automatic);
    Scene scene = mirror_between_walls();
    scene.environment = nullptr;
    // From the right and above, onto the red wall; the mirror sends the lamp itself elsewhere
    DirectionalLight lamp;
    lamp.direction = glm::normalize(glm::dvec3(1.0, 2.0, 0.3));
    lamp.radiance_rec709 = glm::dvec3(400.0);
    lamp.angle_rad = 0.1;
    scene.lights = {lamp};
    const auto [mirrored, wall] = wall_in_mirror(scene, GetParam());
    EXPECT_GT(wall.x, 0.1f);
    EXPECT_NEAR(mirrored.x, wall.x, 0.15f * wall.x);

    // Then again in an environment, and without: nothing of either is left behind
    const View view = look_at({6.0, 12.0, 0.0}, {0.0, 0.5, 0.0}, 0.2, 32, 24);
    scene.eye_in_world_mm = {6.0, 12.0, 0.0};
    const auto geometry = std::make_shared<const FrameGeometry>(scene.product, view);
    RadianceRenderer renderer(geometry, false, GetParam());
    const auto drawn = [&](const Scene& shown) {
        FramePlan plan = plan_frame(shown, dearest_levels(), FrameStage::radiance);
        renderer.render(shown, plan);
        return renderer.read_back();
    };
    const ImageF lamps = drawn(scene);
    Scene both = scene;
    both.environment = mirror_between_walls().environment;
    EXPECT_NE(drawn(both).values, lamps.values);
    EXPECT_EQ(drawn(scene).values, lamps.values);

    // A draft mirrors no parts, and a lamp alone calls for nothing that one would
    const FramePlan draft = plan_frame(scene, Quality::draft, FrameStage::radiance);
    EXPECT_EQ(find_pass(draft, PassKind::mirrored_environment), nullptr);
}

TEST_P(Interreflection, AMirrorShowsWhatAnotherMirrors) {
    // Both walls are mirrors as well. From the eye by the floor and the left wall goes a path to
    // the upper sky, which alone is bright: as a diffuser the wall would be far darker.
    const HeadlessContext context(GlDevice::automatic);
    Scene scene = mirror_between_walls();
    for (std::size_t part : {1u, 2u}) {
        scene.part_materials[part] = scene.part_materials[0];
        scene.part_materials[part].alpha = glm::dvec2(0.2);
        scene.part_materials[part].f0 = {0.9, 0.6, 0.3};
    }
    auto environment = std::make_shared<Environment>(*scene.environment);
    for (int y = 0; y < 16; ++y) {
        const float height = std::max(
            0.0f, std::cos(std::numbers::pi_v<float> * (static_cast<float>(y) + 0.5f) / 16.0f));
        for (int x = 0; x < 32; ++x) {
            for (int c = 0; c < 3; ++c) {
                environment->radiance_working.at(x, y, c) = 0.2f + 4.0f * height * height;
            }
        }
    }
    scene.environment = environment;
    scene.eye_in_world_mm = {6.0, 12.0, 0.0};
    const View view = look_at(scene.eye_in_world_mm, {-0.6, 0.0, 0.0}, 0.02, 16, 16);
    const auto mean_of = [](const ImageF& picture) {
        glm::vec3 sum(0.0f);
        for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
            const float* v = picture.values.data() + 4 * i;
            sum += glm::vec3(v[0], v[1], v[2]);
        }
        return sum / static_cast<float>(picture.pixel_count());
    };
    ReferenceOptions options;
    options.samples_per_pixel = 256;
    const glm::vec3 truth = mean_of(trace_reference(scene, view, options).radiance_working);
    for (const Quality quality : {Quality::normal, Quality::high}) {
        RadianceRenderer renderer(
            std::make_shared<const FrameGeometry>(scene.product, view), false, GetParam());
        FramePlan plan = plan_frame(scene, quality, FrameStage::radiance);
        renderer.render(scene, plan);
        const glm::vec3 mirrored = mean_of(renderer.read_back());
        for (int c = 0; c < 3; ++c) {
            std::printf("    %s, channel %d: %.4f, truth %.4f\n",
                        to_string(quality).data(),
                        c,
                        static_cast<double>(mirrored[c]),
                        static_cast<double>(truth[c]));
            EXPECT_NEAR(mirrored[c], truth[c], 0.1f * truth[c]);
        }
    }
}

TEST_P(Interreflection, AnotherWallIsMirroredAsIfItHadBeenThereAllAlong) {
    const HeadlessContext context(GlDevice::automatic);
    Scene scene = mirror_between_walls();
    scene.eye_in_world_mm = {6.0, 12.0, 0.0};
    const View view = look_at(scene.eye_in_world_mm, {0.0, 0.5, 0.0}, 0.2, 48, 36);
    const auto geometry = std::make_shared<const FrameGeometry>(scene.product, view);
    const auto drawn = [&](RadianceRenderer& renderer) {
        FramePlan plan = plan_frame(scene, Quality::high, FrameStage::radiance);
        renderer.render(scene, plan);
        return renderer.read_back();
    };
    RadianceRenderer kept(geometry, false, GetParam());
    const ImageF red = drawn(kept);
    scene.part_materials[1].diffuse = {0.05, 0.6, 0.05};
    const ImageF green = drawn(kept);
    RadianceRenderer anew(geometry, false, GetParam());
    EXPECT_EQ(green.values, drawn(anew).values);
    EXPECT_NE(green.values, red.values);
}

LIVERY_ON_DEVICES(Interreflection, ShadingDevice::processor, ShadingDevice::gl);

}  // namespace
}  // namespace livery
