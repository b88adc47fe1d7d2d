// The panels drawn without a window: everything fits in the narrowest column, and pointer and keys
// do to the session what they say.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "appearance/fit/recolour.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "scene/library.h"
#include "studio/artwork/artwork_edit.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/paint/library_panel.h"
#include "studio/paint/swatches.h"
#include "studio/panels_fixture.h"
#include "studio/presenting/ballot_panel.h"
#include "studio/studio.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::vector<Artwork> long_names() {
    Artwork artwork;
    artwork.name = "stripes with a name that is longer than any column of any window is wide";
    artwork.paint = "black violet pearl";
    Artwork other = artwork;
    other.shape = ArtworkShape::half;
    return {artwork, other};
}

std::string worn(const Document& document, std::size_t look = 0) {
    const auto& parts = document.looks.at(look).look.parts;
    const auto own = parts.find("sphere");
    return own != parts.end() ? own->second : parts.at("*");
}

TEST_P(Panels, FitIntoTheNarrowestColumn) {
    use_scale(GetParam());
    Studio studio = make_studio();
    studio.ballots = std::make_unique<BallotStore>(home_ / "ballots.sqlite");
    auto frame_shown = std::make_shared<FinishedFrame>();
    frame_shown->plan.passes.resize(2);
    frame_shown->plan.passes[0].id = {
        PassKind::shade, "a-part-with-a-long-name", ReflectanceModel::clearcoat};
    frame_shown->plan.passes[0].why = "a reason that takes more than one line in a narrow column";
    frame_shown->plan.passes[0].ms = 12345.6;
    frame_shown->plan.passes[1].id = {PassKind::prepare, "", ReflectanceModel::clearcoat};
    studio.frame = frame_shown;
    studio.session.execute(SetArtwork{studio.shown_look, long_names()});
    const std::vector<std::pair<DrawPanel, std::vector<std::string>>> panels{
        {draw_of("Artwork"), {"artwork:0", "artwork:1", "artwork:delete", "artwork:centre:z"}},
        {draw_of("Paints"), {"paint:solid red", "paint-search", "family:all"}},
        {draw_of("Paint"), {"param:diffuse", "param:alpha", "reset-paint", "save-paint"}},
        {draw_of("Light"),
         {"light:0:intensity", "light-pad:1", "eye:distance", "exposure", "quality:draft"}},
        {draw_of("Frame"), {"frame-total", "skipped-passes", "pass:prepare:clearcoat"}},
        {draw_of("Calibrate"),
         {"calibrate", "open-nudge", "design-white", "keep-hue", "calibration:none"}},
        {draw_ballot, {"ballot:start", "ballot:look:1", "ballot:close-panel"}}};
    for (const auto& [draw, expected] : panels) {
        const ItemPlaces places = frames(studio, draw, 3);
        for (const std::string& name : expected) EXPECT_TRUE(places.contains(name)) << name;
        // Neither the panel nor what scrolls inside it is wider than what one sees of it.
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if (!window->Active || window->Hidden) continue;
            EXPECT_LE(window->ContentSize.x, window->InnerRect.GetWidth() + 1.0f)
                << window->Name << " with " << expected.front();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scales, Panels, ::testing::Values(1.0f, 2.0f));

TEST_F(Panels, ATooltipIsNeverTallerThanItsText) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const DrawPanel draw = [](Studio& of) {
        paint_tooltip(find_paint(of.session.document(), "bronze metallic"));
    };
    std::vector<float> heights;
    for (int i = 0; i < 8; ++i) {
        frame(studio, draw);
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            const bool seen = (window->Flags & ImGuiWindowFlags_Tooltip) != 0 && window->Active &&
                              !window->Hidden;
            if (seen) heights.push_back(window->Size.y);
        }
    }
    ASSERT_GE(heights.size(), 3u);
    EXPECT_LE(*std::max_element(heights.begin(), heights.end()), 1.01f * heights.back());
}

TEST_F(Panels, ATextsTooltipShowsWhenThePointerRestsOnIt) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const DrawPanel draw = [](Studio&) {
        dim_text("showing");
        name_last_item("text");
        tooltip("What to do about it.");
    };
    const auto is_seen = [] {
        for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
            if ((window->Flags & ImGuiWindowFlags_Tooltip) != 0 && window->Active) return true;
        }
        return false;
    };
    move_to(studio, draw, "text");
    EXPECT_FALSE(is_seen());
    for (int i = 0; i < 120 && !is_seen(); ++i) frame(studio, draw);
    EXPECT_TRUE(is_seen());
}

TEST_F(Panels, PointingTriesAPaintAndClickingPaints) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const std::uint64_t before = studio.session.revision();
    move_to(studio, draw_of("Paints"), "paint:solid blue");
    ASSERT_TRUE(studio.tried);
    EXPECT_EQ(worn(shown_document(studio)), "solid blue");
    EXPECT_EQ(worn(studio.session.document()), "solid red");
    EXPECT_EQ(studio.session.revision(), before);

    click(studio, draw_of("Paints"), "paint:solid blue");
    EXPECT_EQ(worn(studio.session.document()), "solid blue");
    EXPECT_EQ(studio.session.revision(), before + 1);
    EXPECT_EQ(worn(studio.session.document(), 1), "blue metallic");
}

TEST_F(Panels, ArrowsTryPaintsAndEnterPaints) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.panels.of<LibraryPanelState>().focus_search = true;
    studio.panels.of<LibraryPanelState>().search = "blue";
    frames(studio, draw_of("Paints"), 3);
    press(studio, draw_of("Paints"), ImGuiKey_DownArrow);
    EXPECT_EQ(studio.panels.of<LibraryPanelState>().cursor, "blue metallic");
    EXPECT_EQ(worn(shown_document(studio)), "blue metallic");
    press(studio, draw_of("Paints"), ImGuiKey_Enter);
    EXPECT_EQ(worn(studio.session.document()), "blue metallic");
}

TEST_F(Panels, FocusThatComesBackTriesNothing) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const int first = studio.shown_look, second = studio.session.document().looks[1].id;
    click(studio, draw_of("Paints"), "paint:solid blue");
    ASSERT_EQ(worn(studio.session.document()), "solid blue");
    stop_trying(studio);
    show_look(studio, second);  // as by its number key
    frames(studio, draw_of("Paints"), 2);
    click(studio, draw_of("Light"), "light:1");
    frames(studio, draw_of("Paints"), 2);
    EXPECT_FALSE(studio.tried) << text_of(*studio.tried);
    move_away(studio, draw_of("Paints"));
    EXPECT_FALSE(studio.tried) << text_of(*studio.tried);
    EXPECT_EQ(worn(shown_document(studio), 1), "blue metallic");

    // Nor after undo, when the pointer is somewhere else by then.
    show_look(studio, first);
    studio.session.undo();
    frames(studio, draw_of("Paints"), 2);
    EXPECT_FALSE(studio.tried) << text_of(*studio.tried);
    EXPECT_EQ(worn(shown_document(studio)), "solid red");
}

TEST_F(Panels, APointerThatRestsTriesNothing) {
    use_scale(1.0f);
    Studio studio = make_studio();
    // The window comes up under the pointer.
    point_at(frames(studio, draw_of("Paints"), 2), "paint:solid blue");
    frames(studio, draw_of("Paints"), 3);
    EXPECT_FALSE(studio.tried);
    // The pointer leaves and comes back to the same place: another window was over this one.
    const ImVec2 there = ImGui::GetIO().MousePos;
    move_away(studio, draw_of("Paints"));
    ImGui::GetIO().MousePos = there;
    frames(studio, draw_of("Paints"), 2);
    EXPECT_FALSE(studio.tried);
    // The panel changes under it.
    frames(studio, draw_of("Light"), 2);
    frames(studio, draw_of("Paints"), 2);
    EXPECT_FALSE(studio.tried);
    ImGui::GetIO().MousePos.x += 1.0f;
    frames(studio, draw_of("Paints"), 2);
    ASSERT_TRUE(studio.tried);
    EXPECT_EQ(worn(shown_document(studio)), "solid blue");
    frames(studio, draw_of("Paints"), 5);
    EXPECT_TRUE(studio.tried) << "as long as the pointer stays";
}

TEST_F(Panels, APaintFromTheArrowsIsTakenBackWhenTheKeysGoElsewhere) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.panels.of<LibraryPanelState>().focus_search = true;
    studio.panels.of<LibraryPanelState>().search = "blue";
    frames(studio, draw_of("Paints"), 3);
    press(studio, draw_of("Paints"), ImGuiKey_DownArrow);
    ASSERT_TRUE(studio.tried);
    frames(studio, draw_of("Paints"), 3);
    EXPECT_TRUE(studio.tried) << "as long as nothing else happens";
    ImGui::ClearActiveID();
    ImGui::FocusWindow(nullptr);
    frames(studio, draw_of("Paints"), 2);
    EXPECT_FALSE(studio.tried);
    EXPECT_EQ(worn(shown_document(studio)), "solid red");
}

TEST_F(Panels, AJunkEnvironmentIsRefusedWhenItIsChosenAndToldWhenItGoesBad) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const auto junk = home_ / "junk.hdr";
    write_text_file(junk, "no picture at all");
    const std::uint64_t before = studio.session.revision();
    commit(studio, SetEnvironment{studio.shown_look, {junk.string(), 0.0, 1.0}});
    EXPECT_EQ(studio.session.revision(), before);
    ASSERT_EQ(studio.notices.size(), 1u);
    EXPECT_TRUE(says(studio.notices[0].cause, "junk.hdr"));
    frames(studio, draw_of("Light"), 2);
}

TEST_F(Panels, SayWhenNothingIsFound) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.panels.of<LibraryPanelState>().search = "solid rad";
    ItemPlaces places = frames(studio, draw_of("Paints"), 2);
    EXPECT_FALSE(places.contains("paint:solid red"));
    click(studio, draw_of("Paints"), "paint-nearest");
    places = frames(studio, draw_of("Paints"), 2);
    EXPECT_EQ(studio.panels.of<LibraryPanelState>().search, "solid red");
    EXPECT_TRUE(places.contains("paint:solid red"));
}

TEST_F(Panels, DraggingAParameterMakesOneStep) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const std::uint64_t before = studio.session.revision();
    point_at(frames(studio, draw_of("Paint"), 2), "param:coat_alpha");
    frames(studio, draw_of("Paint"), 2);
    ImGui::GetIO().MouseDown[0] = true;
    for (int i = 0; i < 5; ++i) {
        ImGui::GetIO().MousePos.x += 4.0f;
        frame(studio, draw_of("Paint"));
    }
    EXPECT_EQ(studio.session.revision(), before);
    ASSERT_TRUE(studio.tried);
    const Material tried = find_paint(shown_document(studio), "solid red 2");
    ImGui::GetIO().MouseDown[0] = false;
    frames(studio, draw_of("Paint"), 2);
    EXPECT_EQ(studio.session.revision(), before + 1);
    EXPECT_EQ(worn(studio.session.document()), "solid red 2");
    EXPECT_EQ(find_paint(studio.session.document(), "solid red 2").coat_alpha, tried.coat_alpha);
    // The library's own is as it was.
    EXPECT_NE(find_paint(studio.session.document(), "solid red").coat_alpha, tried.coat_alpha);
}

TEST_F(Panels, APressWithoutAChangeIsNoEdit) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const std::uint64_t before = studio.session.revision();
    click(studio, draw_of("Paint"), "param:diffuse:swatch");
    click(studio, draw_of("Paint"), "param:diffuse:r");
    EXPECT_EQ(studio.session.revision(), before);
}

TEST_F(Panels, ALightIsAddedPulledAndRemoved) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const auto lights = [&] { return studio.session.document().looks[0].look.lights; };
    click(studio, draw_of("Light"), "add-light");
    ASSERT_EQ(lights().size(), 3u);
    const glm::dvec3 direction = lights()[2].direction;
    point_at(frames(studio, draw_of("Light"), 2), "light-pad:2");
    frames(studio, draw_of("Light"), 2);
    ImGui::GetIO().MouseDown[0] = true;
    for (int i = 0; i < 5; ++i) {
        ImGui::GetIO().MousePos.x += 5.0f;
        frame(studio, draw_of("Light"));
    }
    EXPECT_EQ(lights()[2].direction, direction);
    ImGui::GetIO().MouseDown[0] = false;
    frames(studio, draw_of("Light"), 2);
    EXPECT_GT(lights()[2].direction.x, direction.x);
    EXPECT_EQ(lights()[0].direction, two_looks().looks[0].look.lights[0].direction);
}

TEST_F(Panels, ArtworkIsTriedInTheMenuAddedDraggedAndUndone) {
    use_scale(1.0f);
    Studio studio = make_studio();
    const auto artwork = [&] { return studio.session.document().looks[0].look.artwork; };
    click(studio, draw_of("Artwork"), "artwork:add");
    frames(studio, draw_of("Artwork"), 2);
    EXPECT_FALSE(studio.tried) << "a list that opens under the pointer tries nothing";
    point_at(frames(studio, draw_of("Artwork"), 3), "artwork:add:dots");
    frames(studio, draw_of("Artwork"), 2);
    ASSERT_TRUE(studio.tried);
    EXPECT_EQ(find_look(shown_document(studio), 1)->look.artwork.size(), 1u);
    EXPECT_TRUE(artwork().empty());
    click(studio, draw_of("Artwork"), "artwork:add:stripes");
    ASSERT_EQ(artwork().size(), 1u);
    EXPECT_EQ(artwork()[0].part, "sphere");
    EXPECT_EQ(artwork()[0].paint, "solid ivory") << "over red";

    const std::uint64_t before = studio.session.revision();
    const double size_mm = artwork()[0].size_mm;
    point_at(frames(studio, draw_of("Artwork"), 2), "artwork:size");
    frames(studio, draw_of("Artwork"), 2);
    ImGui::GetIO().MouseDown[0] = true;
    for (int i = 0; i < 5; ++i) {
        ImGui::GetIO().MousePos.x += 6.0f;
        frame(studio, draw_of("Artwork"));
    }
    EXPECT_EQ(studio.session.revision(), before);
    ASSERT_TRUE(studio.tried);
    EXPECT_NE(find_look(shown_document(studio), 1)->look.artwork[0].size_mm, size_mm);
    ImGui::GetIO().MouseDown[0] = false;
    frames(studio, draw_of("Artwork"), 2);
    EXPECT_EQ(studio.session.revision(), before + 1);
    EXPECT_NE(artwork()[0].size_mm, size_mm);
    studio.session.undo();
    EXPECT_EQ(artwork()[0].size_mm, size_mm);
}

TEST_F(Panels, ArtworkIsOrderedCopiedAndDeleted) {
    use_scale(1.0f);
    Studio studio = make_studio();
    std::vector<Artwork> list = long_names();
    list[0].name = "below";
    list[1].name = "above";
    studio.session.execute(SetArtwork{studio.shown_look, list});
    const auto names = [&] {
        std::string text;
        for (const Artwork& one : studio.session.document().looks[0].look.artwork) {
            text += one.name + " ";
        }
        return text;
    };
    click(studio, draw_of("Artwork"), "artwork:down");
    EXPECT_EQ(names(), "above below ");
    click(studio, draw_of("Artwork"), "artwork:duplicate");
    EXPECT_EQ(names(), "above above 2 below ");
    click(studio, draw_of("Artwork"), "artwork:2");
    click(studio, draw_of("Artwork"), "artwork:delete");
    EXPECT_EQ(names(), "above above 2 ");
    click(studio, draw_of("Artwork"), "artwork:side:above");
    EXPECT_EQ(studio.session.document().looks[0].look.artwork[1].place.direction,
              glm::dvec3(0.0, -1.0, 0.0));
}

TEST_F(Panels, ArtworkThatAPaintCannotWearIsRefusedWithTheReason) {
    use_scale(1.0f);
    Studio studio = make_studio();
    Material matte;
    matte.name = "solid red";
    matte.model = ReflectanceModel::eon;
    studio.session.execute(EditPaint{studio.shown_look, "sphere", matte});
    const auto file = home_ / "print.png";
    write_png(file, Image8(4, 4, 3, 100));
    Artwork print;
    print.name = "print";
    print.shape = ArtworkShape::picture;
    print.picture = file.string();
    studio.session.execute(SetArtwork{studio.shown_look, {print}});
    const std::uint64_t before = studio.session.revision();
    frames(studio, draw_of("Artwork"), 2);
    print.use = PictureUse::roughness;
    set_artwork_at(studio, 0, print);
    EXPECT_EQ(studio.session.revision(), before);
    ASSERT_EQ(studio.notices.size(), 1u);
    EXPECT_EQ(studio.notices[0].what, "\"print\" was not changed.");
    EXPECT_TRUE(says(studio.notices[0].cause, "a map of roughness changes nothing on it"));
    // In a paint of its own it can.
    print.paint = "solid white";
    set_artwork_at(studio, 0, print);
    EXPECT_EQ(studio.session.revision(), before + 1);
}

TEST_F(Panels, ArtworkThatNobodySeesSaysSo) {
    use_scale(1.0f);
    Studio studio = make_studio();
    Artwork dots = long_names()[0];
    dots.shape = ArtworkShape::dots;
    dots.paint.clear();
    studio.session.execute(SetArtwork{studio.shown_look, {dots}});
    EXPECT_TRUE(frames(studio, draw_of("Artwork"), 2).contains("artwork:not-seen"));
    dots.paint = "solid red";
    studio.session.execute(SetArtwork{studio.shown_look, {dots}});
    EXPECT_TRUE(frames(studio, draw_of("Artwork"), 2).contains("artwork:not-seen"));
    dots.paint = "solid blue";
    studio.session.execute(SetArtwork{studio.shown_look, {dots}});
    EXPECT_FALSE(frames(studio, draw_of("Artwork"), 2).contains("artwork:not-seen"));
    // Over other artwork the part's own paint is seen: it leaves that out.
    Artwork own = dots;
    own.paint.clear();
    studio.session.execute(SetArtwork{studio.shown_look, {dots, own}});
    EXPECT_FALSE(frames(studio, draw_of("Artwork"), 2).contains("artwork:not-seen"));
    // A paint that is put below later may not wear it.
    const auto file = home_ / "gloss.png";
    write_png(file, Image8(4, 4, 3, 100));
    Artwork gloss;
    gloss.shape = ArtworkShape::picture;
    gloss.picture = file.string();
    gloss.use = PictureUse::roughness;
    studio.session.execute(SetArtwork{studio.shown_look, {gloss}});
    EXPECT_FALSE(frames(studio, draw_of("Artwork"), 2).contains("artwork:not-seen"));
    Material matte;
    matte.name = "solid red";
    matte.model = ReflectanceModel::eon;
    studio.session.execute(EditPaint{studio.shown_look, "sphere", matte});
    EXPECT_TRUE(frames(studio, draw_of("Artwork"), 2).contains("artwork:not-seen"));
}

TEST_F(Panels, AColourThatThePaintCannotHaveStaysInSight) {
    use_scale(1.0f);
    Studio studio = make_studio();
    Material made =
        with_colour(find_paint(studio.session.document(), "silver metallic"), {90.0, -60.0, 80.0})
            .material;
    made.name = "silver metallic";
    commit(studio, EditPaint{studio.shown_look, "sphere", made});
    EXPECT_TRUE(frames(studio, draw_of("Paint"), 3).contains("paint-colour-asked"));
    const Material now = find_paint(studio.session.document(), "silver metallic 2");
    const auto asked = colour_record(now.provenance);
    ASSERT_TRUE(asked) << now.provenance;
    EXPECT_EQ(asked->asked_lab10, glm::dvec3(90.0, -60.0, 80.0));
    EXPECT_GT(asked->de00, kColourReached);
}

TEST_F(Panels, ArtworkFollowsThePointerUntilItIsPlaced) {
    use_scale(1.0f);
    Studio studio = make_studio();
    studio.session.execute(SetArtwork{studio.shown_look, {long_names()[0]}});
    frames(studio, draw_of("Artwork"), 2);
    EXPECT_FALSE(is_placing(studio));
    click(studio, draw_of("Artwork"), "artwork:place");
    ASSERT_TRUE(is_placing(studio));
    const PickedPoint point{0, {10.0, 20.0, 30.0}, {1.0, 0.0, 0.0}};
    const std::uint64_t before = studio.session.revision();
    try_placing(studio, point);
    ASSERT_TRUE(studio.trying);
    EXPECT_EQ(studio.session.revision(), before);
    place(studio, point);
    EXPECT_FALSE(is_placing(studio));
    EXPECT_EQ(studio.session.revision(), before + 1);
    EXPECT_EQ(studio.session.document().looks[0].look.artwork[0].place.centre_mm,
              point.position_mm);
    // Another look's artwork is not placed by what was begun here.
    click(studio, draw_of("Artwork"), "artwork:place");
    studio.shown_look = studio.session.document().looks[1].id;
    EXPECT_FALSE(is_placing(studio));
}

}  // namespace
}  // namespace livery
