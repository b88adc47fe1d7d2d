// Artwork in frames: filtered over the pixel, for nothing where there is none.
#include <numbers>

#include <fmt/format.h>

#include "appearance/model_table.h"
#include "core/image_io.h"
#include "radiance/artwork_inputs.h"
#include "radiance/direct_oracle.h"
#include "radiance/raster_preview.h"
#include "radiance/renderer_fixture.h"
#include "scene/artwork_coats.h"
#include "support/radiance_error.h"
#include "support/shading_devices.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using ArtworkFrame = Renderer;

LIVERY_ON_DEVICES(ArtworkFrame, ShadingDevice::processor, ShadingDevice::gl);

/// Rings in colours, with holes; values from dark to light along x.
void write_picture(const std::filesystem::path& file) {
    ImageF image(180, 120, 4);
    for (int y = 0; y < 120; ++y) {
        for (int x = 0; x < 180; ++x) {
            const double r = 0.5 * std::hypot(x - 90, y - 60);
            float* pixel = image.pixel(x, y);
            pixel[0] = 0.1f + 0.005f * static_cast<float>(x);
            pixel[1] = 0.8f - 0.005f * static_cast<float>(y);
            pixel[2] = std::fmod(r, 12.0) < 6.0 ? 0.7f : 0.05f;
            pixel[3] = r > 8.0 ? 1.0f : 0.0f;
        }
    }
    write_exr(file, image);
}

struct ArtworkCase {
    std::string name;
    Artwork artwork;
    Material material;
};

std::vector<ArtworkCase> cases(const std::filesystem::path& picture) {
    const Material glossy = paint_of(ReflectanceModel::ggx, 0.2);
    Material coated = paint_of(ReflectanceModel::clearcoat, 0.1);
    coated.diffuse = {0.05, 0.5, 0.6};
    Material rough = paint_of(ReflectanceModel::blinn_phong, 0.2);
    rough.diffuse = {0.1, 0.5, 0.2};
    std::vector<ArtworkCase> list;
    for (const ArtworkShape shape :
         {ArtworkShape::half, ArtworkShape::stripes, ArtworkShape::checks, ArtworkShape::dots}) {
        Artwork artwork;
        artwork.shape = shape;
        artwork.size_mm = 7.0;
        artwork.place.centre_mm = {3.0, 1.0, 0.0};
        artwork.place.up = {0.3, 1.0, 0.0};
        list.push_back({kArtworkShapes[static_cast<std::size_t>(shape)], artwork, coated});
    }
    list.push_back({"stripes finer than a pixel", list[1].artwork, rough});
    list.back().artwork.size_mm = 1.1;
    for (const PictureUse use : {PictureUse::cover, PictureUse::colours, PictureUse::roughness}) {
        Artwork artwork;
        artwork.shape = ArtworkShape::picture;
        artwork.picture = picture.string();
        artwork.use = use;
        artwork.size_mm = 50.0;
        artwork.place.centre_mm = {0.0, 5.0, 40.0};
        artwork.place.through = false;
        const Material& material = use == PictureUse::roughness ? glossy : coated;
        list.push_back({kPictureUses[static_cast<std::size_t>(use)], artwork, material});
    }
    list.push_back({"tint of a metal", list[6].artwork, glossy});
    list.back().artwork.use = PictureUse::tint;
    list.back().material.diffuse = glm::dvec3(0.0);
    list.back().material.f0 = {0.9, 0.8, 0.6};
    list.push_back({"colours on flakes", list[6].artwork, coated});
    list.back().material.f0 = {0.9, 0.7, 0.3};
    list.push_back({"colours by uv, repeated", list[6].artwork, rough});
    list.back().artwork.place = {};
    list.back().artwork.place.by_uv = true;
    list.back().artwork.repeat = true;
    return list;
}

Scene scene_with(const ArtworkCase& one) {
    Scene scene = scene_of(two_spheres(), paint_of(ReflectanceModel::lambert, 0.2));
    scene.lights = {light_from({0.3, 0.6, 0.8}, 0.05), light_from({-0.6, 0.1, 0.8}, 0.05, 0.5)};
    const auto picture =
        one.artwork.picture.empty() ? nullptr : load_artwork_picture(one.artwork.picture);
    scene.artwork = {make_part_artwork(0, one.artwork, one.material, picture)};
    return scene;
}

TEST_P(ArtworkFrame, AgreesWithBruteForce) {
    const TemporaryFolder folder;
    write_picture(folder / "rings.exr");
    const View view = test_view(96, 72);
    for (const ArtworkCase& one : cases(folder / "rings.exr")) {
        const Scene scene = scene_with(one);
        const RadianceError error =
            radiance_error(draw(scene, view), direct_light(scene, view, {16, 0}));
        std::printf("    %-28s median %.4f p90 %.4f p99 %.4f bias %+.5f\n",
                    one.name.c_str(),
                    error.median,
                    error.p90,
                    error.p99,
                    error.mean_signed);
        // Brute force's 256 rays a pixel err by up to 1/16 of a contrast at an edge; a Gaussian
        // footprint by .06 of it. Edges are a third of some of these pixels.
        EXPECT_LT(error.median, 0.01) << one.name;
        EXPECT_LT(error.p99, 0.12) << one.name;
        EXPECT_LT(std::abs(error.mean_signed), 2e-3) << one.name;
    }
}

TEST_P(ArtworkFrame, BothDevicesDrawTheSame) {
    const TemporaryFolder folder;
    write_picture(folder / "rings.exr");
    const View view = test_view(64, 48);
    const ShadingDevice other = in_opengl() ? ShadingDevice::processor : ShadingDevice::gl;
    for (const ArtworkCase& one : cases(folder / "rings.exr")) {
        Scene scene = scene_with(one);
        scene.environment = studio();
        const ImageF a = draw(scene, view, Quality::draft, GetParam());
        const ImageF b = draw(scene, view, Quality::draft, other);
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            // Half floats after each paint in OpenGL
            ASSERT_NEAR(a.values[i], b.values[i], 6e-3f * (0.05f + a.values[i])) << one.name;
        }
    }
}

TEST_P(ArtworkFrame, ThePreviewShowsIt) {
    const TemporaryFolder folder;
    write_picture(folder / "rings.exr");
    const View view = test_view(120, 90);
    for (const ArtworkCase& one : cases(folder / "rings.exr")) {
        const Scene scene = scene_with(one);
        Scene without = scene;
        without.artwork.clear();
        RasterPreview preview(scene.product, 4);
        preview.render(scene, view);
        const ImageF shown = preview.read_back();
        preview.render(without, view);
        const ImageF bare = preview.read_back();
        const ImageF wanted = draw(scene, view);
        double difference = 0.0, change = 0.0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < wanted.pixel_count(); ++i) {
            if (wanted.values[4 * i + 3] < 1.0f || shown.values[4 * i + 3] < 1.0f) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t at = 4 * i + c;
                difference += static_cast<double>(std::abs(shown.values[at] - wanted.values[at]));
                change += static_cast<double>(std::abs(shown.values[at] - bare.values[at]));
            }
            count += 3;
        }
        difference /= static_cast<double>(count);
        change /= static_cast<double>(count);
        std::printf("    %-28s preview differs by %.4f, artwork by %.4f\n",
                    one.name.c_str(),
                    difference,
                    change);
        EXPECT_LT(difference, 0.01) << one.name;
        EXPECT_GT(change, 4.0 * difference) << one.name;
    }
}

TEST_P(ArtworkFrame, CostsOnlyWhatChanged) {
    const TemporaryFolder folder;
    write_picture(folder / "rings.exr");
    const auto list = cases(folder / "rings.exr");
    Scene scene = scene_with(list[1]);
    RadianceRenderer renderer = renderer_of(scene, test_view(64, 48));
    const std::vector<PartArtwork> artwork = std::exchange(scene.artwork, {});
    const auto draw_again = [&] {
        const auto before = renderer.counters();
        FramePlan its_plan = plan(scene);
        renderer.render(scene, its_plan);
        const auto after = renderer.counters();
        return RadianceRenderer::Counters{after.programs - before.programs,
                                          after.textures - before.textures,
                                          after.passes_run - before.passes_run,
                                          after.fragments_shaded - before.fragments_shaded};
    };
    draw_again();
    EXPECT_EQ(find_pass(plan(scene), PassKind::artwork), nullptr);
    const ImageF bare = renderer.read_back();
    EXPECT_EQ(draw_again().passes_run, 0);

    // Its cover is solved, directions for its paint, and its part is shaded
    scene.artwork = artwork;
    EXPECT_GT(draw_again().passes_run, 3);
    const ImageF worn = renderer.read_back();
    EXPECT_NE(worn.values, bare.values);
    EXPECT_EQ(draw_again().passes_run, 0);
    EXPECT_EQ(worn.values, draw(scene, test_view(64, 48)).values);

    // Another paint solves nothing: the part, the artwork over it and the resolve
    scene.artwork[0].material.diffuse = {0.7, 0.1, 0.1};
    auto cost = draw_again();
    EXPECT_EQ(cost.passes_run, 3);
    EXPECT_EQ(cost.textures, 0);
    EXPECT_EQ(cost.programs, 0);
    // Another place solves its cover; another part's paint leaves it alone
    scene.artwork[0].artwork.place.centre_mm.x += 2.0;
    EXPECT_EQ(draw_again().passes_run, 4);
    scene.part_materials[1].diffuse = {0.2, 0.2, 0.7};
    EXPECT_EQ(draw_again().passes_run, 2);
    // A second one over the first, then the first taken away
    scene.artwork.push_back(scene_with(list[3]).artwork[0]);
    draw_again();
    EXPECT_EQ(renderer.read_back().values, draw(scene, test_view(64, 48)).values);
    scene.artwork.erase(scene.artwork.begin());
    draw_again();
    EXPECT_EQ(renderer.read_back().values, draw(scene, test_view(64, 48)).values);
    scene.artwork.clear();
    scene.part_materials[1] = scene.part_materials[0];
    draw_again();
    EXPECT_EQ(renderer.read_back().values, bare.values);
}

/// Waves along both directions, as normals.
void write_waves(const std::filesystem::path& file) {
    ImageF image(256, 256, 3);
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const double step = 2.0 * std::numbers::pi / 64.0;
            const glm::dvec3 normal = glm::normalize(glm::dvec3(
                0.3 * std::cos(step * (x + 0.5)), 0.25 * std::sin(step * (y + 0.5)), 1.0));
            for (int c = 0; c < 3; ++c) {
                image.at(x, y, c) = static_cast<float>(0.5 + 0.5 * normal[c]);
            }
        }
    }
    write_exr(file, image);
}

struct Relief {
    std::string name;
    double size_mm;  ///< of the picture: four waves
    bool by_uv;
};

Scene scene_with(const Relief& how,
                 const Material& material,
                 const std::filesystem::path& picture) {
    Scene scene = scene_of(two_spheres(), material);
    scene.lights = {light_from({0.3, 0.6, 0.8}, 0.05), light_from({-0.6, 0.1, 0.8}, 0.05, 0.5)};
    Artwork artwork;
    artwork.shape = ArtworkShape::picture;
    artwork.use = PictureUse::relief;
    artwork.picture = picture.string();
    artwork.repeat = true;
    artwork.size_mm = how.size_mm;
    artwork.place.by_uv = how.by_uv;
    artwork.place.up = {0.2, 1.0, 0.0};
    scene.relief = {make_part_artwork(0, artwork, material, load_artwork_picture(picture))};
    return scene;
}

TEST_P(ArtworkFrame, AReliefAgreesWithBruteForce) {
    const TemporaryFolder folder;
    write_waves(folder / "waves.exr");
    const View view = test_view(96, 72);
    // Pixels of 1.8 mm: waves of 20 mm are shown, those of 1 mm only widen what is mirrored
    for (const Relief& how : {Relief{"waves of 20 mm", 80.0, false},
                              Relief{"waves of 1 mm", 4.0, false},
                              Relief{"along u and v", 1.0, true}}) {
        for (const auto model : {ReflectanceModel::lambert, ReflectanceModel::ggx}) {
            const Material material = paint_of(model, 0.3);
            const Scene scene = scene_with(how, material, folder / "waves.exr");
            Scene flat = scene;
            flat.relief.clear();
            const ImageF truth = direct_light(scene, view, {16, 0});
            const ImageF drawn = draw(scene, view);
            const RadianceError error = radiance_error(drawn, truth);
            const RadianceError without = radiance_error(draw(flat, view), truth);
            std::printf("    %-16s %-8s median %.4f p90 %.4f p99 %.4f bias %+.5f, flat %.4f %.4f\n",
                        how.name.c_str(),
                        model_info(model).name,
                        error.median,
                        error.p90,
                        error.p99,
                        error.mean_signed,
                        without.median,
                        without.p90);
            // Waves within a pixel turn its diffuse light down by half their mean squared slope
            // (.038 of it), which one mean normal of length 1 does not.
            const bool within_a_pixel = how.size_mm < 50.0 && !how.by_uv;
            EXPECT_LT(error.median, within_a_pixel ? 0.02 : 0.002) << how.name;
            EXPECT_LT(error.p99, within_a_pixel ? 0.06 : 0.04) << how.name;
            EXPECT_LT(std::abs(error.mean_signed), within_a_pixel ? 0.01 : 5e-4) << how.name;
            if (!within_a_pixel) {
                EXPECT_LT(error.p90, 0.05 * without.p90) << how.name;
            }
        }
    }
}

TEST_P(ArtworkFrame, AReliefIsAnotherSurfaceForLight) {
    const TemporaryFolder folder;
    write_waves(folder / "waves.exr");
    const View view = test_view(64, 48);
    Scene scene = scene_with(
        {"waves", 80.0, false}, paint_of(ReflectanceModel::clearcoat, 0.05), folder / "waves.exr");
    scene.environment = studio();
    RadianceRenderer renderer = renderer_of(scene, view);
    const auto draw_again = [&] {
        FramePlan its_plan = plan(scene);
        renderer.render(scene, its_plan);
        return renderer.read_back();
    };
    const std::vector<PartArtwork> relief = std::exchange(scene.relief, {});
    const ImageF flat = draw_again();
    scene.relief = relief;
    const ImageF waves = draw_again();
    EXPECT_NE(waves.values, flat.values);
    EXPECT_EQ(waves.values, draw(scene, view).values);
    const int passes = renderer.counters().passes_run;
    draw_again();
    EXPECT_EQ(renderer.counters().passes_run, passes);
    scene.relief.clear();
    EXPECT_EQ(draw_again().values, flat.values);
    // On both devices alike
    scene.relief = relief;
    const ImageF other = draw(
        scene, view, Quality::normal, in_opengl() ? ShadingDevice::processor : ShadingDevice::gl);
    for (std::size_t i = 0; i < waves.values.size(); ++i) {
        ASSERT_NEAR(waves.values[i], other.values[i], 4e-3f * (0.01f + waves.values[i])) << i;
    }
}

TEST_P(ArtworkFrame, ThePreviewShowsARelief) {
    const TemporaryFolder folder;
    write_waves(folder / "waves.exr");
    const View view = test_view(120, 90);
    for (const bool by_uv : {false, true}) {
        const Scene scene = scene_with(
            {"waves", 80.0, by_uv}, paint_of(ReflectanceModel::ggx, 0.3), folder / "waves.exr");
        Scene flat = scene;
        flat.relief.clear();
        RasterPreview preview(scene.product, 4);
        preview.render(scene, view);
        const RadianceError error = radiance_error(preview.read_back(), draw(scene, view));
        const RadianceError without = radiance_error(preview.read_back(), draw(flat, view));
        std::printf(
            "    relief in the preview: median %.4f, without %.4f\n", error.median, without.median);
        EXPECT_LT(error.median, 0.005);
        EXPECT_GT(without.median, 4.0 * error.median);
    }
}

TEST(Footprint, IsThePixelOnTheSurface) {
    const View view = test_view(96, 72);
    // On a plane that lies askew: a pixel's corners, met by rays
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.4, 0.2, 1.0)), point(3, 4, 5);
    const auto meets = [&](glm::dvec2 pixel) {
        const Ray ray = ray_through(view, pixel);
        return ray.origin + glm::dot(point - ray.origin, normal) / glm::dot(ray.direction, normal) *
                                ray.direction;
    };
    const glm::dvec3 at = meets({50.5, 30.5});
    const Footprint footprint = footprint_of(view, 30 * 96 + 50, at, normal);
    EXPECT_LT(glm::distance(footprint.a, meets({51.0, 30.5}) - meets({50.0, 30.5})), 1e-3);
    EXPECT_LT(glm::distance(footprint.b, meets({50.5, 31.0}) - meets({50.5, 30.0})), 1e-3);
    // Along the ray it stays finite
    const glm::dvec3 ray = ray_through(view, {50.5, 30.5}).direction;
    const glm::dvec3 edge = glm::normalize(glm::cross(ray, glm::dvec3(0, 1, 0)));
    const Footprint grazing = footprint_of(view, 30 * 96 + 50, at, edge);
    EXPECT_LT(glm::length(grazing.a), 31.0 * glm::length(footprint.b));
}

}  // namespace
}  // namespace livery
