// Artwork in a session: set as a whole, checked before it is taken, gone with its file and back
// with it.
#include <gtest/gtest.h>

#include "core/image_io.h"
#include "scene/library.h"
#include "session/commands.h"
#include "session/look_exchange.h"
#include "session/some_commands.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery::testing {
namespace {

std::string refusal(const Artwork& artwork) {
    return message_of([&] { applied(car(), SetArtwork{1, {artwork}}); });
}

const std::vector<Artwork>& artwork_of(const Document& document, int look) {
    return find_look(document, look)->look.artwork;
}

Artwork decal(const std::filesystem::path& picture) {
    Artwork artwork;
    artwork.part = "body";
    artwork.shape = ArtworkShape::picture;
    artwork.picture = picture.string();
    artwork.use = PictureUse::colours;
    artwork.place.through = false;
    return artwork;
}

TEST(SetArtwork, TakesPaintsAsTheLibraryWritesThemAndSaysWhatIsUndone) {
    Artwork artwork = some_artwork();
    artwork.paint = "Solid-Ivory";
    const Document after = applied(car(), SetArtwork{1, {artwork}});
    ASSERT_EQ(artwork_of(after, 1).size(), 1u);
    EXPECT_EQ(artwork_of(after, 1)[0].paint, "solid ivory");
    EXPECT_TRUE(artwork_of(after, 2).empty());
    EXPECT_EQ(label_of(car(), SetArtwork{1, {artwork}}), "Change artwork of blue metallic");
    EXPECT_EQ(parse_document(text_of(after), "a test").looks[0].look.artwork, artwork_of(after, 1));
    // One paint on everything, as a clay model wears it
    EXPECT_TRUE(artwork_of(applied(after, PaintProduct{1, "matte grey"}), 1).empty());
    EXPECT_EQ(artwork_of(applied(after, DuplicateLook{1}), 5).size(), 1u);
}

TEST(SetArtwork, RefusesWhatCannotBeDrawn) {
    const TemporaryFolder folder;
    const auto changed = [](const auto& change) {
        Artwork artwork = some_artwork();
        change(artwork);
        return refusal(artwork);
    };
    EXPECT_TRUE(says(changed([](Artwork& a) { a.part = "sails"; }), "there is no part \"sails\""));
    EXPECT_TRUE(says(changed([](Artwork& a) { a.paint = "solid rad"; }), "nearest: 'solid red'"));
    EXPECT_TRUE(says(changed([](Artwork& a) { a.size_mm = NAN; }), "size_mm is nan"));
    EXPECT_TRUE(says(changed([](Artwork& a) { a.place.up = a.place.direction; }), "along"));
    EXPECT_NE(refusal(decal("nowhere.png")).find("nowhere.png"), std::string::npos);
    EXPECT_NE(refusal(decal(folder.write("x.png", "no picture"))).find("x.png"), std::string::npos);
    Artwork relief = decal(folder / "waves.png");
    write_png(relief.picture, Image8(4, 4, 3, 128));
    relief.use = PictureUse::relief;
    EXPECT_EQ(refusal(relief), "nothing thrown");
    EXPECT_NE(message_of([&] {
                  applied(car(), SetArtwork{1, {relief, relief}});
              }).find("two reliefs"),
              std::string::npos);
    Artwork rough = decal(folder / "grey.png");
    write_png(rough.picture, Image8(4, 4, 3, 100));
    rough.use = PictureUse::roughness;
    rough.paint = "solid red";
    EXPECT_EQ(refusal(rough), "nothing thrown");
    EXPECT_NE(message_of([] {
                  applied(car(), SetArtwork{1, std::vector<Artwork>(40, some_artwork())});
              }).find("40 artworks"),
              std::string::npos);
}

TEST(SetArtwork, APictureThatIsGoneIsToldAndShownAgainWhenItIsBack) {
    const TemporaryFolder folder;
    const auto file = folder / "badge.png";
    write_png(file, Image8(4, 4, 3, 100));
    const Document document = applied(car(), SetArtwork{1, {decal(file), some_artwork()}});
    const auto product = find_product("car");
    EXPECT_EQ(scene_of(document, 1, product).artwork.size(), 2u);
    EXPECT_TRUE(drawing_problems(document).empty());
    std::filesystem::rename(file, folder / "elsewhere.png");
    EXPECT_EQ(scene_of(document, 1, product).artwork.size(), 1u);
    const auto problems = drawing_problems(document);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_NE(problems[0].find("body of blue metallic"), std::string::npos) << problems[0];
    EXPECT_NE(problems[0].find("badge.png"), std::string::npos) << problems[0];
    EXPECT_EQ(artwork_of(parse_document(text_of(document), "a test"), 1).size(), 2u);
    std::filesystem::rename(folder / "elsewhere.png", file);
    EXPECT_EQ(scene_of(document, 1, product).artwork.size(), 2u);
}

TEST(SetArtwork, OnAPartsOwnPaintIsLeftOutWhileThatCannotWearIt) {
    const TemporaryFolder folder;
    Artwork rough = decal(folder / "grey.png");
    write_png(rough.picture, Image8(4, 4, 3, 100));
    rough.use = PictureUse::roughness;
    Material chalk = some_paint();
    chalk.model = ReflectanceModel::eon;
    const auto product = find_product("car");
    const Document glossy = applied(car(), SetArtwork{1, {rough}});
    EXPECT_EQ(scene_of(glossy, 1, product).artwork.size(), 1u);
    const Document matte = applied(glossy, EditPaint{1, "body", chalk});
    EXPECT_EQ(scene_of(matte, 1, product).artwork.size(), 0u);
    EXPECT_EQ(scene_of(applied(matte, SetPaint{1, "body", "solid red"}), 1, product).artwork.size(),
              1u);
}

TEST(SetArtwork, GoesOutWithALookAndComesBack) {
    const TemporaryFolder folder;
    const auto file = folder / "badge.png";
    write_png(file, Image8(4, 4, 3, 100));
    Artwork own = some_artwork();
    Document document = applied(car(), EditPaint{1, "body", some_paint()});
    own.paint = find_look(document, 1)->look.parts.at("body");
    document = applied(document, SetArtwork{1, {decal(file), own}});
    const auto written = export_look(document, 1, folder / "look.json");
    EXPECT_EQ(written.size(), 2u) << "the look and its own paint";
    const Look look = read_look_file(folder / "look.json");
    EXPECT_NE(look.artwork[1].paint, own.paint) << "the paint's file beside it";
    const Document back = testing::applied_with_files(car(), AddLook{look});
    ASSERT_EQ(artwork_of(back, 5).size(), 2u);
    EXPECT_EQ(find_paint(back, artwork_of(back, 5)[1].paint).diffuse, some_paint().diffuse);
}

TEST(EditPaint, KnowsThatArtworkWearsAPaintAsWell) {
    Document document = applied(car(), EditPaint{1, "body", some_paint()});
    const std::string name = find_look(document, 1)->look.parts.at("body");
    Artwork artwork = some_artwork();
    artwork.paint = name;
    document = applied(document, SetArtwork{2, {artwork}});
    Material edited = find_paint(document, name);
    edited.diffuse = {0.1, 0.1, 0.9};
    const Document after = applied(document, EditPaint{1, "body", edited});
    EXPECT_EQ(find_paint(after, name).diffuse, some_paint().diffuse) << "artwork keeps its own";
}

}  // namespace
}  // namespace livery::testing
