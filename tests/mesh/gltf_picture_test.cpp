// What becomes of the pictures in glTF's materials.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/colour.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "mesh/gltf_builder.h"
#include "mesh/mesh.h"
#include "scene/look.h"
#include "scene/scene.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using Use = PartPicture::Use;
constexpr const char* kPlain = R"("metallicFactor": 0, "roughnessFactor": 0.5)";

class GltfPictureTest : public ::testing::Test {
  protected:
    /// A picture of 8 bits beside the model, a pixel a value.
    void write(const std::string& name, int width, const std::vector<std::uint8_t>& rgb) {
        Image8 image(width, static_cast<int>(rgb.size()) / 3 / width, 3);
        image.values = rgb;
        write_png(folder_ / name, image);
    }
    /// A plate whose material has these members; textures 0, 1, … are the pictures named.
    GltfBuilder plate_with(const std::string& members, const std::vector<std::string>& pictures) {
        GltfBuilder plate = make_plate();
        Json material = Json::parse("{" + members + "}");
        material["name"] = "skin";
        plate.json["materials"] = Json::array({material});
        plate.json["textures"] = Json::array();
        plate.json["images"] = Json::array();
        for (std::size_t k = 0; k < pictures.size(); ++k) {
            plate.json["textures"].push_back({{"source", k}});
            plate.json["images"].push_back({{"uri", pictures[k]}});
        }
        plate.primitive()["material"] = 0;
        return plate;
    }
    Mesh load(const GltfBuilder& plate) {
        notes_.clear();
        return load_mesh(folder_.write("mesh.glb", plate.glb()), &notes_);
    }
    Part part_of(const std::string& members, const std::vector<std::string>& pictures) {
        return load(plate_with(members, pictures)).parts.at(0);
    }
    bool noted(const std::string& text) const {
        return std::any_of(notes_.begin(), notes_.end(), [&](const std::string& note) {
            return note.find(text) != std::string::npos;
        });
    }

    TemporaryFolder folder_;
    std::vector<std::string> notes_;
};

std::string pbr(const std::string& members) {
    return R"("pbrMetallicRoughness": {)" + members + "}";
}

/// What is seen at a texel of paints that lie over one another: the mean of a value of theirs.
template <typename Value>
double seen(const Part& part, std::size_t texel, const Value& value) {
    double left = 1.0, sum = 0.0;
    for (std::size_t k = part.pictures.size(); k-- > 0;) {
        const PartPicture& one = part.pictures[k];
        if (one.use != Use::tint) continue;
        const double alpha = static_cast<double>(one.picture->rgba.values[4 * texel + 3]);
        sum += left * alpha * value(one.paint);
        left *= 1.0 - alpha;
    }
    EXPECT_NEAR(left, 0.0, 1e-6);  // nothing of the part's own paint is left
    return sum;
}

TEST_F(GltfPictureTest, ColoursTintThePaintInLinearLightTimesTheFactor) {
    write("a.png", 2, {255, 128, 0, 64, 255, 32});
    const Part part =
        part_of(pbr(std::string(kPlain) +
                    R"(, "baseColorFactor": [0.5, 1, 0.25, 1], "baseColorTexture": {"index": 0})"),
                {"a.png"});
    EXPECT_TRUE(notes_.empty());
    ASSERT_EQ(part.pictures.size(), 1u);
    const PartPicture& worn = part.pictures[0];
    EXPECT_EQ(worn.use, Use::tint);
    EXPECT_EQ(worn.paint.diffuse, glm::dvec3(1.0));
    EXPECT_NEAR(worn.paint.alpha.x, 0.25, 1e-12);
    EXPECT_TRUE(worn.picture->linear);
    const auto& rgba = worn.picture->rgba.values;
    ASSERT_EQ(rgba.size(), 8u);
    const float wanted[] = {0.5f,
                            static_cast<float>(srgb_decode(128.0 / 255.0)),
                            0.0f,
                            1.0f,
                            0.5f * static_cast<float>(srgb_decode(64.0 / 255.0)),
                            1.0f,
                            0.25f * static_cast<float>(srgb_decode(32.0 / 255.0)),
                            1.0f};
    for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(rgba[k], wanted[k], 1e-5f) << k;
    // Lists and swatches show the mean.
    EXPECT_NEAR(part.base_colour_rec709.x, 0.5 * static_cast<double>(rgba[0] + rgba[4]), 1e-6);
}

TEST_F(GltfPictureTest, PicturesInsideTheFileAreTheSame) {
    write("a.png", 2, {255, 128, 0, 64, 255, 32});
    const std::string members = pbr(std::string(kPlain) + R"(, "baseColorTexture": {"index": 0})");
    const Part beside = part_of(members, {"a.png"});
    const std::string bytes = read_text_file(folder_ / "a.png");
    GltfBuilder inside = plate_with(members, {"a.png"});
    const int view = inside.add_view(std::vector<char>(bytes.begin(), bytes.end()));
    inside.json["images"][0] = {{"bufferView", view}, {"mimeType", "image/png"}};
    const Part embedded = load(inside).parts.at(0);
    EXPECT_TRUE(notes_.empty());
    ASSERT_EQ(embedded.pictures.size(), 1u);
    EXPECT_EQ(embedded.pictures[0].picture->rgba.values, beside.pictures[0].picture->rgba.values);

    std::string uri = "data:image/png,";
    for (const char c : bytes) {
        uri += fmt::format("%{:02x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
    const Part by_uri = part_of(members, {uri});
    ASSERT_EQ(by_uri.pictures.size(), 1u);
    EXPECT_EQ(by_uri.pictures[0].picture->rgba.values, beside.pictures[0].picture->rgba.values);
}

TEST_F(GltfPictureTest, PicturesThatCannotBeReadAreNamed) {
    const std::string members = pbr(R"("baseColorTexture": {"index": 0})");
    EXPECT_TRUE(part_of(members, {"gone.png"}).pictures.empty());
    EXPECT_TRUE(noted("material \"skin\": the picture \"gone.png\" is missing; its plain colour"));
    part_of(members, {"../up.png"});
    EXPECT_TRUE(noted("\"../up.png\" is not read: it is not beside the model"));
    write("a.png", 1, {1, 2, 3});
    const std::string cut = read_text_file(folder_ / "a.png").substr(0, 40);
    folder_.write("cut.png", cut);
    EXPECT_TRUE(part_of(members, {"cut.png"}).pictures.empty());
    EXPECT_TRUE(noted("the picture \"cut.png\" is not read: "));
    folder_.write("no.png", "GIF89a");
    part_of(members, {"no.png"});
    EXPECT_TRUE(noted("the picture \"no.png\" is not read: content of another kind"));
    GltfBuilder webp = plate_with(members, {"a.webp"});
    webp.json["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
    load(webp);
    EXPECT_TRUE(noted("a picture by EXT_texture_webp is not read"));
}

TEST_F(GltfPictureTest, EvenRoughnessAndMetalGoIntoThePaint) {
    write("mr.png", 2, {0, 128, 255, 99, 128, 255});
    const Part part = part_of(
        pbr(R"("roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 0})"), {"mr.png"});
    EXPECT_TRUE(part.pictures.empty());
    ASSERT_TRUE(part.paint);
    EXPECT_EQ(part.paint->diffuse, glm::dvec3(0.0));
    EXPECT_NEAR(part.paint->alpha.x, std::pow(0.5 * 128.0 / 255.0, 2.0), 1e-6);
    EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfPictureTest, RoughnessAloneIsAMapOfIt) {
    write("mr.png", 3, {0, 51, 0, 0, 153, 0, 0, 255, 0});
    const Part part = part_of(
        pbr(R"("metallicFactor": 0, "metallicRoughnessTexture": {"index": 0})"), {"mr.png"});
    ASSERT_EQ(part.pictures.size(), 1u);
    EXPECT_EQ(part.pictures[0].use, Use::roughness);
    EXPECT_NEAR(part.pictures[0].paint.alpha.x, 1.0, 1e-6);
    EXPECT_NEAR(part.pictures[0].picture->rgba.values[1], 0.2f, 1e-6f);
}

TEST_F(GltfPictureTest, ColoursRoughnessAndMetalTogetherAreMixedOfPaints) {
    // Roughness rises over the columns, metal over the rows.
    std::vector<std::uint8_t> colours, values;
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 8; ++x) {
            colours.insert(colours.end(), {200, static_cast<std::uint8_t>(20 * x), 60});
            values.insert(
                values.end(),
                {0, static_cast<std::uint8_t>(60 + 25 * x), static_cast<std::uint8_t>(85 * y)});
        }
    }
    write("a.png", 8, colours);
    write("mr.png", 8, values);
    const Part part = part_of(
        pbr(R"("baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1})"),
        {"a.png", "mr.png"});
    EXPECT_TRUE(notes_.empty());
    ASSERT_GT(part.pictures.size(), 2u);
    ASSERT_LE(part.pictures.size(), 12u);
    for (std::size_t i = 0; i < 32; ++i) {
        const double metal = static_cast<double>(values[3 * i + 2]) / 255.0;
        const double rough = static_cast<double>(values[3 * i + 1]) / 255.0;
        EXPECT_NEAR(
            seen(part, i, [](const Material& m) { return 1.0 - m.diffuse.x; }), metal, 1e-5);
        const double mean =
            seen(part, i, [](const Material& m) { return 0.5 * std::log(m.alpha.x); });
        EXPECT_NEAR(mean, std::log(rough), 1e-5);
    }
}

TEST_F(GltfPictureTest, PartOfAMetalIsMixedOfAPigmentAndAMetal) {
    write("a.png", 1, {255, 255, 255});
    const Part part = part_of(
        pbr(R"("metallicFactor": 0.3, "roughnessFactor": 0.5, "baseColorTexture": {"index": 0})"),
        {"a.png"});
    ASSERT_EQ(part.pictures.size(), 2u);
    EXPECT_NEAR(seen(part, 0, [](const Material& m) { return m.diffuse.x; }), 0.7, 1e-6);
    EXPECT_NEAR(seen(part, 0, [](const Material& m) { return m.f0.x; }), 0.7 * 0.04 + 0.3, 1e-6);
}

TEST_F(GltfPictureTest, ACoatComesAndGoesWithItsPicture) {
    write("coat.png", 3, {0, 0, 0, 102, 0, 0, 255, 0, 0});
    const Part part = part_of(pbr(kPlain) + R"(, "extensions": {"KHR_materials_clearcoat":
        {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0}}})",
                              {"coat.png"});
    const auto coat_f0 = [](const Material& m) {
        return m.model == ReflectanceModel::clearcoat ? m.coat_f0 : 0.0;
    };
    EXPECT_NEAR(seen(part, 0, coat_f0), 0.0, 1e-9);
    EXPECT_NEAR(seen(part, 1, coat_f0), 0.4 * 0.04, 1e-6);
    EXPECT_NEAR(seen(part, 2, coat_f0), 0.04, 1e-6);
    EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfPictureTest, NormalsAreARelief) {
    write("n.png", 1, {255, 128, 255});
    const Part part = part_of(R"("normalTexture": {"index": 0, "scale": 0.5})", {"n.png"});
    ASSERT_EQ(part.pictures.size(), 1u);
    EXPECT_EQ(part.pictures[0].use, Use::relief);
    EXPECT_EQ(part.pictures[0].depth, 0.5);
    EXPECT_FALSE(part.paint);
    EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfPictureTest, OcclusionAndEmissionAreLeftOutByName) {
    write("o.png", 1, {255, 128, 255});
    part_of(R"("occlusionTexture": {"index": 0}, "emissiveTexture": {"index": 0})", {"o.png"});
    EXPECT_TRUE(noted("material \"skin\": occlusionTexture, emissiveTexture not read"));
}

TEST_F(GltfPictureTest, TransformsMoveTheTextureCoordinates) {
    write("a.png", 1, {9, 9, 9});
    const auto uvs_with = [&](const char* transform) {
        return load(plate_with(pbr(fmt::format(
                                   R"("baseColorTexture": {{"index": 0, "extensions":
            {{"KHR_texture_transform": {}}}}})",
                                   transform)),
                               {"a.png"}))
            .uvs;
    };
    // Corners 1 (u 1, v 1) and 2 (u 1, v 0) of the plate.
    auto uvs = uvs_with(R"({"offset": [0.25, 0.5], "scale": [2, 3]})");
    EXPECT_NEAR(glm::distance(uvs[1], glm::vec2(2.25, 3.5)), 0.0, 1e-6);
    EXPECT_NEAR(glm::distance(uvs[2], glm::vec2(2.25, 0.5)), 0.0, 1e-6);
    // A quarter turn counter-clockwise takes u to where v falls: up the picture.
    uvs = uvs_with(R"({"rotation": 1.5707963267948966})");
    EXPECT_NEAR(glm::distance(uvs[2], glm::vec2(0, -1)), 0.0, 1e-6);
    EXPECT_NEAR(glm::distance(uvs[1], glm::vec2(1, -1)), 0.0, 1e-6);
    // Scaled, then turned, then moved
    uvs = uvs_with(R"({"rotation": 1.5707963267948966, "scale": [2, 3], "offset": [0.5, 0]})");
    EXPECT_NEAR(glm::distance(uvs[1], glm::vec2(3.5, -2)), 0.0, 1e-6);
    EXPECT_TRUE(notes_.empty());
}

TEST_F(GltfPictureTest, OtherTextureCoordinatesAreReadAndMixedOnesNamed) {
    write("a.png", 1, {9, 9, 9});
    GltfBuilder plate = plate_with(pbr(R"("baseColorTexture": {"index": 0, "texCoord": 1})") +
                                       R"(, "normalTexture": {"index": 0})",
                                   {"a.png"});
    plate.attributes()["TEXCOORD_1"] =
        plate.add(std::vector<float>{5, 5, 6, 5, 6, 6, 5, 6}, "VEC2", 5126, 4);
    EXPECT_EQ(load(plate).uvs[2], glm::vec2(6, 6));
    EXPECT_TRUE(noted("normalTexture lies along other texture coordinates than baseColorTexture"));
}

TEST_F(GltfPictureTest, AScenesPartsWearThemUntilALookPaintsThem) {
    write("a.png", 1, {200, 100, 50});
    write("n.png", 1, {160, 128, 230});
    const GltfBuilder plate =
        plate_with(pbr(std::string(kPlain) + R"(, "baseColorTexture": {"index": 0})") +
                       R"(, "normalTexture": {"index": 1})",
                   {"a.png", "n.png"});
    auto product = std::make_shared<Product>();
    product->mesh = load(plate);
    Look look;
    const Scene own = make_scene(product, look, glm::dvec3(0, 0, 1000));
    ASSERT_EQ(own.artwork.size(), 1u);
    EXPECT_EQ(own.artwork[0].artwork.use, PictureUse::tint);
    EXPECT_TRUE(own.artwork[0].artwork.place.by_uv);
    EXPECT_EQ(own.artwork[0].picture, product->mesh.parts[0].pictures[1].picture);
    EXPECT_EQ(own.relief.size(), 1u);

    Material paint;
    paint.name = "mine";
    look.parts["plate"] = "mine";
    const auto find = [&](const std::string&) { return paint; };
    const Scene painted = make_scene(product, look, find, glm::dvec3(0, 0, 1000));
    EXPECT_TRUE(painted.artwork.empty());
    EXPECT_EQ(painted.relief.size(), 1u);
}

}  // namespace
}  // namespace livery
