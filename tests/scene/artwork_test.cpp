// Artwork on a product: where it lies, what it is painted with.
#include "scene/artwork.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "appearance/paint_bsdf.h"
#include "appearance/paint_figures.h"
#include "core/colour.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "scene/artwork_cover.h"
#include "scene/artwork_picture.h"
#include "scene/scene.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

TEST(ArtworkPlane, HasItsAxesAsSeenAgainstTheProjection) {
    ArtworkPlace place;
    place.centre_mm = {10, 20, 30};
    place.direction = {0, -5, 0};  // from above
    place.up = {0, 7, -2};         // away from somebody in front
    const ArtworkPlane plane = plane_of(place);
    EXPECT_LT(glm::distance(plane.toward, glm::dvec3(0, 1, 0)), 1e-15);
    EXPECT_LT(glm::distance(plane.t_axis, glm::dvec3(0, 0, -1)), 1e-15);
    EXPECT_LT(glm::distance(plane.s_axis, glm::dvec3(1, 0, 0)), 1e-15);
    EXPECT_LT(glm::distance(plane * glm::dvec3(13, 99, 26), glm::dvec2(3, 4)), 1e-12);
}

TEST(ArtworkPlane, PutOntoASurfaceItFacesItAndStandsUpright) {
    for (const glm::dvec3 normal : {glm::dvec3(0, 0, 1),
                                    glm::dvec3(1, 1, 0),
                                    glm::dvec3(0, 1, 0),
                                    glm::dvec3(0.1, -1, 0.2)}) {
        Artwork artwork;
        artwork.place = place_on({1, 2, 3}, normal, false);
        check_artwork(artwork);
        const ArtworkPlane plane = plane_of(artwork.place);
        EXPECT_LT(glm::distance(plane.toward, glm::normalize(normal)), 1e-12);
        EXPECT_NEAR(glm::dot(plane.s_axis, plane.t_axis), 0.0, 1e-12);
        EXPECT_LT(glm::length(plane * glm::dvec3(1, 2, 3)), 1e-12);
        if (std::abs(normal.y) < 0.9) {
            EXPECT_GT(plane.t_axis.y, 0.0) << "upright";
        }
    }
}

Material coated() {
    Material material;
    material.name = "coated";
    material.model = ReflectanceModel::clearcoat;
    material.diffuse = {0.2, 0.3, 0.4};
    return material;
}

constexpr float kGrey = 0.2159f;  // linear: half of what sRGB can say

/// A picture of two columns: white, and half covered in middle grey.
std::shared_ptr<const ArtworkPicture> two_columns(const TemporaryFolder& folder) {
    ImageF image(2, 1, 4, 1.0f);
    for (int c = 0; c < 3; ++c) image.at(1, 0, c) = kGrey;
    image.at(1, 0, 3) = 0.5f;
    write_exr(folder / "columns.exr", image);
    return load_artwork_picture(folder / "columns.exr");
}

Artwork picture_used_as(PictureUse use) {
    Artwork artwork;
    artwork.shape = ArtworkShape::picture;
    artwork.picture = "columns.exr";
    artwork.use = use;
    return artwork;
}

TEST(ArtworkCoats, AColouredPictureIsAMixtureOfAWhiteAndABlackPigment) {
    const TemporaryFolder folder;
    const auto picture = two_columns(folder);
    const PartArtwork artwork =
        make_part_artwork(0, picture_used_as(PictureUse::colours), coated(), picture);
    const auto coats = coats_of(artwork);
    ASSERT_EQ(coats.size(), 2u);
    EXPECT_EQ(coats[0].material.diffuse, glm::dvec3(0.0));
    EXPECT_EQ(coats[1].material.diffuse, glm::dvec3(1.0));
    const ImageF layers = picture_layers(*picture, PictureUse::colours, artwork.pigment_response);
    ASSERT_EQ(layers.channels, 4);
    EXPECT_NEAR(layers.at(0, 0, 0), 1.0f, 1e-3f);
    // Under a coat a middle grey is darker than its share of white: most of its light comes back
    // from the coat and is absorbed
    const float grey = layers.at(1, 0, 0) / layers.at(1, 0, 3);
    EXPECT_NEAR(layers.at(1, 0, 3), 0.5f, 1e-6f);
    EXPECT_LT(grey, 0.75f * kGrey);
    EXPECT_GT(grey, 0.25f * kGrey);
    // Both together return as much as a pigment of that colour does
    const auto returned = [](const Material& material) {
        return environment_weights(bsdf_of(material), 0.5f).diffuse.x;
    };
    const float mixed = grey * returned(coats[1].material);
    EXPECT_NEAR(mixed, returned(material_at(artwork, {kGrey, kGrey, kGrey, 1.0f})), 1e-3f);
}

TEST(ArtworkCoats, ColoursOfWholeNumbersAreSrgb) {
    const TemporaryFolder folder;
    write_png(folder / "grey.png", Image8(1, 1, 3, 128));
    const auto picture = load_artwork_picture(folder / "grey.png");
    const PartArtwork artwork =
        make_part_artwork(0, picture_used_as(PictureUse::colours), Material(), picture);
    const ImageF layers = picture_layers(*picture, PictureUse::colours, artwork.pigment_response);
    EXPECT_NEAR(layers.at(0, 0, 0), kGrey, 1e-4f);
    EXPECT_NEAR(material_at(artwork, {0.50196f, 0.50196f, 0.50196f, 1.0f}).diffuse.x, kGrey, 1e-4f);
}

/// Seen from straight above in light from 45 degrees.
glm::dvec3 lab_at_45(const Material& material) { return five_angle_lab(material)[kFaceAngle]; }

TEST(ArtworkCoats, APrintIsOpaqueInkWhateverThePaintIsMadeOf) {
    const TemporaryFolder folder;
    const auto picture = two_columns(folder);
    const glm::vec4 yellow{0.8f, 0.55f, 0.01f, 1.0f};
    const auto printed = [&](const Material& paint) {
        return material_at(
            make_part_artwork(0, picture_used_as(PictureUse::colours), paint, picture), yellow);
    };
    const auto paint_named = [](const std::string& name) {
        return read_material_file(shipped_path("materials/" + name + ".json"));
    };
    for (const char* name : {"blue-metallic",
                             "silver-metallic",
                             "gold-metallic",
                             "dark-red-metallic",
                             "black-rose-pearl",
                             "two-coat-silver"}) {
        const Material paint = paint_named(name);
        // The same as on a white paint under such a clear coat: nobody could tell them apart.
        Material white = paint_named("solid-white");
        white.coat_alpha = paint.coat_alpha;
        white.coat_f0 = paint.coat_f0;
        const glm::dvec3 lab = lab_at_45(printed(paint));
        EXPECT_LT(ciede2000(lab, lab_at_45(printed(white))), 0.01) << name;
        EXPECT_GT(lab.z, 45.0) << name << " is yellow";
    }
    // Bare metal is covered too: lighter and yellower than the metal.
    for (const char* name : {"polished-brass", "brushed-steel", "chrome-steel"}) {
        const Material metal = paint_named(name);
        const glm::dvec3 lab = lab_at_45(printed(metal));
        EXPECT_GT(lab.z, 45.0) << name;
        EXPECT_GT(lab.x, lab_at_45(metal).x) << name;
    }
}

TEST(ArtworkCoats, ATintLeavesFlakesAndMetal) {
    const TemporaryFolder folder;
    const auto picture = two_columns(folder);
    const Material flakes = read_material_file(shipped_path("materials/silver-metallic.json"));
    const PartArtwork tint =
        make_part_artwork(0, picture_used_as(PictureUse::tint), flakes, picture);
    EXPECT_EQ(material_at(tint, glm::vec4(0.5f)).f0, flakes.f0);
    EXPECT_EQ(material_at(tint, glm::vec4(0.5f)).model, flakes.model);
}

TEST(ArtworkCoats, ATintedMetalTakesItsColourFromItsReflectance) {
    const TemporaryFolder folder;
    const auto picture = two_columns(folder);
    Material metal;
    metal.model = ReflectanceModel::ggx;
    metal.diffuse = glm::dvec3(0.0);
    metal.f0 = {0.9, 0.8, 0.5};
    const PartArtwork artwork =
        make_part_artwork(0, picture_used_as(PictureUse::tint), metal, picture);
    const auto coats = coats_of(artwork);
    // Whatever the colour, the two ends' weights make it
    for (const double colour : {0.0, 0.3, 1.0}) {
        glm::dvec3 f0(0.0);
        for (const ArtworkCoat& coat : coats) {
            f0 += (static_cast<double>(coat.of_colour) * colour +
                   static_cast<double>(coat.of_alpha)) *
                  coat.material.f0;
        }
        EXPECT_LT(glm::distance(f0, colour * metal.f0), 1e-6);
    }
}

TEST(ArtworkCoats, AMapOfRoughnessIsAMixtureOfStepsThatAddUpToOne) {
    const TemporaryFolder folder;
    Image8 ramp(256, 1, 1);
    for (int x = 0; x < 256; ++x) ramp.at(x, 0) = static_cast<std::uint8_t>(x);
    write_png(folder / "ramp.png", ramp);
    const auto picture = load_artwork_picture(folder / "ramp.png");
    const auto steps = roughness_steps(*picture);
    ASSERT_EQ(steps.size(), kMostRoughnessSteps);
    Material glossy;
    glossy.model = ReflectanceModel::ggx;
    glossy.alpha = {0.5, 0.25};
    const PartArtwork artwork =
        make_part_artwork(0, picture_used_as(PictureUse::roughness), glossy, picture);
    const auto coats = coats_of(artwork);
    ASSERT_EQ(coats.size(), steps.size());
    EXPECT_EQ(coats.back().material.alpha, glm::dvec2(0.5, 0.25)) << "white leaves it as it is";
    const ImageF layers = picture_layers(*picture, PictureUse::roughness, {});
    for (int x = 0; x < 256; ++x) {
        double sum = 0.0, log_scale = 0.0;
        for (std::size_t k = 0; k < steps.size(); ++k) {
            const auto share = static_cast<double>(layers.at(x, 0, static_cast<int>(4 * k)));
            EXPECT_GE(share, 0.0);
            sum += share;
            log_scale += share * std::log(steps[k]);
        }
        ASSERT_NEAR(sum, 1.0, 1e-6) << x;
        EXPECT_NEAR(log_scale, std::log(slope_scale(static_cast<float>(x) / 255.0f)), 1e-4) << x;
    }
}

TEST(ArtworkCoats, APaintThatCannotWearItIsRefused) {
    const TemporaryFolder folder;
    const auto picture = two_columns(folder);
    Material plain;
    plain.name = "chalk";
    EXPECT_THROW(make_part_artwork(0, picture_used_as(PictureUse::roughness), plain, picture),
                 std::invalid_argument);
    Material measured;
    measured.name = "measured";
    measured.model = ReflectanceModel::measured;
    EXPECT_THROW(make_part_artwork(0, picture_used_as(PictureUse::colours), measured, picture),
                 std::invalid_argument);
    make_part_artwork(0, picture_used_as(PictureUse::cover), measured, picture);
}

std::shared_ptr<const Product> two_parts() {
    auto product = std::make_shared<Product>();
    product->name = "balls";
    product->mesh = make_sphere({0, 0, 0}, 40.0, 8, "body");
    append(product->mesh, make_sphere({99, 0, 0}, 40.0, 8, "wheel"), "");
    return product;
}

TEST(ArtworkScene, LiesOnItsPartsInTheirOrder) {
    const TemporaryFolder folder;
    two_columns(folder);
    Look look;
    look.file = folder / "look.json";
    look.artwork.resize(2);
    look.artwork[0].part = "wheel";
    look.artwork[1] = picture_used_as(PictureUse::colours);
    const Scene scene = make_scene(two_parts(), look, {0, 0, 500});
    ASSERT_EQ(scene.artwork.size(), 3u);
    EXPECT_EQ(scene.artwork[0].part, 1u);
    EXPECT_EQ(scene.artwork[1].part, 0u);
    EXPECT_EQ(scene.artwork[2].part, 1u);
    EXPECT_EQ(scene.artwork[1].picture, scene.artwork[2].picture) << "read once";
    // The same picture the next time: a scene is made whenever the pointer moves
    const Scene again = make_scene(two_parts(), look, {0, 0, 500});
    EXPECT_EQ(again.artwork[1].picture, scene.artwork[1].picture);

    look.artwork[0].part = "sail";
    EXPECT_TRUE(fails_with(
        [&] {
            make_scene(two_parts(), look, {0, 0, 500});
        },
        {"artwork[0].part", "body", "wheel"}));
    look.artwork[0].part = "body";
    look.artwork[1].picture = "nowhere.png";
    EXPECT_TRUE(fails_with(
        [&] {
            make_scene(two_parts(), look, {0, 0, 500});
        },
        {"nowhere.png", "a picture"}));
    folder.write("nowhere.png", "no picture at all");
    EXPECT_TRUE(fails_with([&] { make_scene(two_parts(), look, {0, 0, 500}); }, {"nowhere.png"}));
}

TEST(ArtworkScene, APartHasOneReliefAtMost) {
    const TemporaryFolder folder;
    two_columns(folder);
    Look look;
    look.file = folder / "look.json";
    look.artwork.resize(2, picture_used_as(PictureUse::relief));
    look.artwork[0].part = "wheel";
    look.artwork[1].part = "body";
    const Scene scene = make_scene(two_parts(), look, {0, 0, 500});
    EXPECT_TRUE(scene.artwork.empty());
    ASSERT_EQ(scene.relief.size(), 2u);
    EXPECT_EQ(relief_of(scene, 0), &scene.relief[1]);
    look.artwork[1].part = "*";
    EXPECT_TRUE(fails_with(
        [&] {
            make_scene(two_parts(), look, {0, 0, 500});
        },
        {"artwork[1]", "a second relief of part wheel"}));
}

TEST(ArtworkRelief, TiltsTheSurfaceAsThePictureSays) {
    Artwork artwork = picture_used_as(PictureUse::relief);
    artwork.depth = 2.0;
    const PartArtwork relief{0, artwork, {}, nullptr, {}};
    // Seen from the front, right is +x and up +y; as steep again as the picture says
    const ReliefFrame frame = relief_frame(relief, {0, 0, 1}, {1, 0, 0, 1});
    EXPECT_LT(glm::distance(frame.right, glm::dvec3(1, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(frame.up, glm::dvec3(0, 1, 0)), 1e-12);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.2, 1.0));
    const glm::vec4 texel(0.5 * normal + 0.5, 1.0);
    const ReliefTilt tilt = tilt_at(relief, {1.0, texel});
    EXPECT_NEAR(tilt.slope.x, 0.6, 1e-6);
    EXPECT_NEAR(tilt.slope.y, -0.4, 1e-6);
    const glm::dvec3 steeper = tilted({0, 0, 1}, frame, tilt.slope);
    EXPECT_LT(glm::distance(steeper, glm::normalize(glm::dvec3(0.6, -0.4, 1.0))), 1e-6);
    // Half of the footprint flat, half sloped: the mean, and what is spread around it
    const ReliefTilt mean = tilt_of(relief, {0.15, 0.0, 0.045, 1.0});
    EXPECT_NEAR(mean.slope.x, 0.3, 1e-12);
    EXPECT_NEAR(mean.variance, 0.09, 1e-12);
    // Along the mesh's texture coordinates, mirrored ones as well
    PartArtwork by_uv = relief;
    by_uv.artwork.place.by_uv = true;
    EXPECT_LT(glm::distance(relief_frame(by_uv, {0, 0, 1}, {0, 1, 0, -1}).up, glm::dvec3(1, 0, 0)),
              1e-12);
    // Texels that are no normals at all stay finite
    for (const glm::vec4& bad : {glm::vec4(0.0f), glm::vec4(1.0f, 0.5f, 0.0f, 1.0f)}) {
        const glm::dvec3 n = tilted({0, 0, 1}, frame, tilt_at(relief, {1.0, bad}).slope);
        EXPECT_NEAR(glm::length(n), 1.0, 1e-9);
        EXPECT_GT(n.z, 0.0);
    }
}

TEST(ArtworkPicture, IsReadAnewWhenItsFileHasChanged) {
    const TemporaryFolder folder;
    const auto first = two_columns(folder);
    EXPECT_EQ(load_artwork_picture(folder / "columns.exr"), first);
    write_exr(folder / "columns.exr", ImageF(3, 5, 3, 0.5f));
    std::filesystem::last_write_time(
        folder / "columns.exr",
        std::filesystem::last_write_time(folder / "columns.exr") + std::chrono::seconds(2));
    const auto second = load_artwork_picture(folder / "columns.exr");
    EXPECT_EQ(second->rgba.width, 3);
    EXPECT_FALSE(second->has_alpha);
    EXPECT_EQ(second->rgba.at(0, 0, 3), 1.0f);
    ImageF bad(2, 2, 3);
    bad.at(1, 1, 2) = NAN;
    write_exr(folder / "bad.exr", bad);
    EXPECT_TRUE(fails_with([&] { load_artwork_picture(folder / "bad.exr"); }, {"not finite"}));
}

}  // namespace
}  // namespace livery
