// Commands: what each does to the document, what it refuses, and its text.

#include "session/commands.h"

#include <algorithm>
#include <clocale>
#include <limits>

#include <gtest/gtest.h>

#include "appearance/fit/recolour.h"
#include "session/some_commands.h"
#include "support/file_error.h"
#include "support/message_of.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::car;
using testing::one_of_each;
using testing::some_paint;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What the refused command says; empty (and a failure) when it is taken.
std::string refusal(const SessionCommand& command, const Document& document = car()) {
    try {
        applied(document, command);
    } catch (const std::invalid_argument& mistake) {
        return mistake.what();
    }
    ADD_FAILURE() << "taken: " << text_of(command);
    return "";
}

std::string worn(const Document& document, int look, const std::string& part) {
    const SessionLook* found = find_look(document, look);
    return found && found->look.parts.contains(part) ? found->look.parts.at(part) : "";
}

TEST(LookNames, FollowThePaintThatTheyAreNamedAfter) {
    const auto name_of = [](const Document& document) { return document.looks.at(0).look.name; };
    const auto painted =
        [&](const Document& before, const std::string& part, const std::string& paint) {
            const std::string name = look_name_after(before.looks.at(0).look, part, paint);
            return part.empty() ? applied(before, PaintProduct{1, paint, name})
                                : applied(before, SetPaint{1, part, paint, name});
        };
    ASSERT_EQ(name_of(car()), "blue metallic");
    // What tells the look's colour: a wheel's paint does not, nor the paint that it has already
    EXPECT_EQ(name_of(painted(car(), "rims", "solid white")), "blue metallic");
    EXPECT_EQ(name_of(painted(car(), "body", "blue metallic")), "blue metallic");
    EXPECT_EQ(name_of(painted(car(), "body", "solid white")), "solid white");
    EXPECT_EQ(name_of(painted(car(), "", "solid white")), "solid white");
    // Another look has the name
    EXPECT_EQ(name_of(painted(car(), "body", "silver metallic")), "silver metallic 2");
    const Document twice =
        painted(painted(car(), "body", "silver metallic"), "body", "solid black");
    EXPECT_EQ(name_of(twice), "solid black");
    // A name that somebody gave stays, and commands that say nothing change none
    const Document renamed = applied(car(), RenameLook{1, "the boss's choice"});
    EXPECT_EQ(name_of(painted(renamed, "body", "solid white")), "the boss's choice");
    EXPECT_EQ(name_of(applied(car(), SetPaint{1, "body", "solid white"})), "blue metallic");
    const SessionCommand command = SetPaint{1, "body", "solid white", "solid white"};
    EXPECT_EQ(text_of(parse_session_command(text_of(command), "a test")), text_of(command));
    EXPECT_EQ(refusal(SetPaint{1, "body", "solid white", "a\nb"}), refusal(RenameLook{1, "a\nb"}));
}

TEST(Commands, EachIsTheSameAfterWritingAndReading) {
    const TemporaryFolder folder;
    folder.write("calibration.json", "{}");
    const auto commands = one_of_each(folder.path().string());
    const Document before = testing::car_with_own_paint();
    std::vector<bool> seen(std::variant_size_v<SessionCommand>);
    for (const SessionCommand& command : commands) {
        const std::string text = text_of(command);
        EXPECT_EQ(text.find('\n'), std::string::npos);
        const SessionCommand back = parse_session_command(text, "a test");
        ASSERT_EQ(back.index(), command.index()) << text;
        EXPECT_EQ(text_of(back), text);
        const std::string after = text_of(applied(before, command));
        EXPECT_EQ(text_of(applied(before, back)), after) << text;
        EXPECT_NE(after, text_of(before)) << text << " changes nothing";
        seen[command.index()] = true;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), std::ssize(seen));
    EXPECT_EQ(text_of(SessionCommand(SetPaint{1, "body", "solid red"})),
              R"({"set-paint":{"look":1,"part":"body","paint":"solid red"}})");
}

TEST(Commands, TextsAreTheSameWhereACommaSplitsDecimals) {
    const std::string before = std::setlocale(LC_ALL, nullptr);
    const SessionCommand command = SetExposure{0.125};
    const std::string text = text_of(command), document = text_of(applied(car(), command));
    ::setenv("LOCPATH", LIVERY_TEST_LOCALES, 1);
    ASSERT_TRUE(std::setlocale(LC_ALL, "de_DE.UTF-8")) << "none in " LIVERY_TEST_LOCALES;
    EXPECT_EQ(text_of(command), text);
    EXPECT_EQ(label_of(car(), command), "Set exposure to 0.125 EV");
    const Document read = applied(car(), parse_session_command(text, "a test"));
    EXPECT_EQ(read.exposure_ev, 0.125);
    EXPECT_EQ(text_of(parse_document(document, "a test")), document);
    std::setlocale(LC_ALL, before.c_str());
    ::unsetenv("LOCPATH");
}

TEST(Commands, LabelsSayWhatIsUndone) {
    const auto label = [](const SessionCommand& command) { return label_of(car(), command); };
    EXPECT_EQ(label(SetPaint{1, "body", "Solid-Red"}), "Paint body solid red");
    EXPECT_EQ(label(SetPaint{1, "*", "/a/b/mine.json"}), "Paint the rest /a/b/mine.json");
    EXPECT_EQ(label(PaintProduct{1, "Solid-Red"}), "Paint the whole product solid red");
    EXPECT_EQ(label(EditPaint{1, "rims", some_paint()}), "Edit solid red on rims");
    Look dusk;
    dusk.name = "dusk";
    EXPECT_EQ(label(AddLook{dusk}), "Add look dusk");
    EXPECT_EQ(label(DuplicateLook{2}), "Duplicate look silver metallic");
    EXPECT_EQ(label(RenameLook{2, "dusk"}), "Rename look silver metallic to dusk");
    EXPECT_EQ(label(RenamePaint{"solid red 2", "Monza"}), "Rename paint solid red 2 to Monza");
    EXPECT_EQ(label(DeleteLook{2}), "Delete look silver metallic");
    EXPECT_EQ(label(DeleteLook{77}), "Delete look 77");
    EXPECT_EQ(label(MoveLook{2, 0}), "Move look silver metallic");
    EXPECT_EQ(label(SetLights{2, {}}), "Change lights of silver metallic");
    EXPECT_EQ(label(SetEnvironment{2, {}}), "Change environment of silver metallic");
    EXPECT_EQ(label(ShareLighting{2}), "Light all looks as silver metallic");
    EXPECT_EQ(label(SetEye{}), "Move eye point");
    EXPECT_EQ(label(SetQuality{Quality::high}), "Set quality to high");
    EXPECT_EQ(label(SetCalibration{"/home/x/calibrations/2026-11-21"}),
              "Use calibration 2026-11-21");
    EXPECT_EQ(label(SetCalibration{}), "Use no calibration");
    EXPECT_EQ(label(SetBench{"hard"}), "Use bench hard");
    EXPECT_EQ(label(SetDesignWhite{20}), "Set design white to 20 %");
    EXPECT_EQ(label(SetGamutMapping{GamutMapping::preserve}), "Keep hues out of reach");
    EXPECT_EQ(label(SetGamutMapping{GamutMapping::strict}), "Clip colours out of reach");
}

TEST(Commands, KnowTheLookThatTheyAreAbout) {
    EXPECT_EQ(look_of(car(), SetPaint{2, "body", "solid red"}), 2);
    EXPECT_EQ(look_of(applied(car(), DuplicateLook{2}), DuplicateLook{2}), 5);
    EXPECT_EQ(look_of(applied(car(), DeleteLook{2}), DeleteLook{2}), std::nullopt);
    EXPECT_EQ(look_of(car(), SetExposure{1.0}), std::nullopt);
}

TEST(SetPaint, TakesPaintsAsTheLibraryWritesThem) {
    EXPECT_EQ(worn(applied(car(), SetPaint{1, "body", "Solid-Red"}), 1, "body"), "solid red");
    const TemporaryFolder folder;
    const auto file = folder / "mein Lack.json";
    write_material_file(file, some_paint());
    const SetPaint command{1, "body", file.string()};
    EXPECT_EQ(refusal(command), file.string() + " was not read yet");
    const Document painted = testing::applied_with_files(car(), command);
    EXPECT_EQ(worn(painted, 1, "body"), file.string());
    EXPECT_EQ(find_paint(painted, worn(painted, 1, "body")).name, "solid red");
}

TEST(PaintProduct, LeavesNoPartInItsOwnPaint) {
    const Document painted = applied(car(), PaintProduct{1, "Solid-Red"});
    EXPECT_EQ(find_look(painted, 1)->look.parts,
              (std::map<std::string, std::string>{{"*", "solid red"}}));
    EXPECT_EQ(find_look(painted, 2)->look.parts, find_look(car(), 2)->look.parts);
    EXPECT_EQ(refusal(PaintProduct{7, "solid red"}), refusal(SetPaint{7, "body", "solid red"}));
    EXPECT_TRUE(says(refusal(PaintProduct{1, "solid rad"}), "nearest: 'solid red'"));
}

TEST(SetPaint, SaysWhatThereIsWhenSomethingIsNot) {
    EXPECT_EQ(refusal(SetPaint{7, "body", "solid red"}),
              "there is no look 7; there are 1 (blue metallic), 2 (silver metallic), 3 (solid "
              "ivory), 4 (solid red)");
    EXPECT_TRUE(says(refusal(SetPaint{1, "sails", "solid red"}), "no part \"sails\" in car"));
    EXPECT_TRUE(says(refusal(SetPaint{1, "body", "solid rad"}), "nearest: 'solid red'"));
    EXPECT_NE(refusal(SetPaint{1, "body", "\xff"}).find("not UTF-8"), std::string::npos);
}

TEST(EditPaint, ForksALibraryPaintUnderANumberedName) {
    const Document document = applied(car(), EditPaint{4, "body", some_paint()});
    EXPECT_EQ(worn(document, 4, "body"), "solid red 2");
    ASSERT_EQ(document.paints.size(), 1u);
    EXPECT_EQ(document.paints[0].name, "solid red 2");
    EXPECT_EQ(document.paints[0].diffuse, some_paint().diffuse);
    EXPECT_EQ(document.paints[0].provenance, "edited in a session, from solid red");
    EXPECT_EQ(find_paint(document, "Solid-Red-2").diffuse, some_paint().diffuse);
    EXPECT_NE(find_paint(document, "solid red").diffuse, some_paint().diffuse);
    const auto names = paint_names(document);
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
    EXPECT_EQ(std::count(names.begin(), names.end(), "solid red 2"), 1);
}

TEST(EditPaint, ChangesInPlaceWhatNothingElseWears) {
    Document document = applied(car(), EditPaint{4, "body", some_paint()});
    Material changed = find_paint(document, "solid red 2");
    changed.alpha = {0.4, 0.4};
    document = applied(document, EditPaint{4, "body", changed});
    EXPECT_EQ(worn(document, 4, "body"), "solid red 2");
    ASSERT_EQ(document.paints.size(), 1u);
    EXPECT_EQ(document.paints[0].alpha.x, 0.4);

    changed.name = "sunset";
    document = applied(document, EditPaint{4, "body", changed});
    EXPECT_EQ(worn(document, 4, "body"), "sunset");
    ASSERT_EQ(document.paints.size(), 1u);
    changed.name = "solid blue";
    document = applied(document, EditPaint{4, "body", changed});
    EXPECT_EQ(worn(document, 4, "body"), "solid blue 2") << "never the library's name";
}

TEST(EditPaint, RecordsAColourThatWasAskedForUntilThePaintIsChangedAgain) {
    const glm::dvec3 asked{90.0, -60.0, 80.0};
    const auto in_colour = [&](const Document& document, const std::string& paint) {
        Material made = with_colour(find_paint(document, paint), asked).material;
        made.name = paint;
        return applied(document, EditPaint{4, "body", made});
    };
    const auto recorded = [](const Document& document) {
        return colour_record(document.paints.at(0).provenance);
    };
    // A paint of the library, then one of the session's own.
    Document document = in_colour(car(), "silver metallic");
    ASSERT_TRUE(recorded(document)) << document.paints.at(0).provenance;
    EXPECT_EQ(recorded(document)->asked_lab10, asked);
    EXPECT_GT(recorded(document)->de00, 1.0);
    EXPECT_EQ(without_colour_record(document.paints[0].provenance),
              "edited in a session, from silver metallic");
    Material changed = document.paints[0];
    changed.coat_alpha = 0.3;
    const Document later = applied(document, EditPaint{4, "body", changed});
    EXPECT_FALSE(recorded(later)) << later.paints[0].provenance;
    document = in_colour(later, later.paints[0].name);
    ASSERT_TRUE(recorded(document)) << document.paints.at(0).provenance;
    EXPECT_EQ(without_colour_record(document.paints[0].provenance),
              "edited in a session, from silver metallic");
    // It is saved with the session.
    EXPECT_TRUE(recorded(parse_document(text_of(document), "test")));
}

TEST(EditPaint, ForksWhatAnotherPartOrLookWearsAsWell) {
    const Document one = applied(car(), EditPaint{4, "body", some_paint()});
    for (const SessionCommand& sharing :
         {SessionCommand(SetPaint{4, "trim", "solid red 2"}), SessionCommand(DuplicateLook{4})}) {
        const Document shared = applied(one, sharing);
        Material changed = find_paint(shared, "solid red 2");
        changed.diffuse = {0.25, 0.25, 0.25};
        const Document after = applied(shared, EditPaint{4, "body", changed});
        EXPECT_EQ(worn(after, 4, "body"), "solid red 3");
        EXPECT_EQ(after.paints.size(), 2u);
        EXPECT_EQ(find_paint(after, "solid red 2").diffuse, some_paint().diffuse);
    }
    // The rest's paint becomes a part's own, and the rest keeps it.
    Document rest = applied(car(), EditPaint{4, "*", some_paint()});
    rest = applied(rest, EditPaint{4, "body", find_paint(rest, "solid red 2")});
    EXPECT_EQ(worn(rest, 4, "*"), "solid red 2");
    EXPECT_EQ(worn(rest, 4, "body"), "solid red 3");
}

TEST(RenamePaint, IsFollowedWhereverThePaintIsWorn) {
    Document document = applied(car(), EditPaint{4, "body", some_paint()});
    document = applied(document, SetPaint{1, "trim", "solid red 2"});
    Artwork stripes;
    stripes.paint = "solid red 2";
    document = applied(document, SetArtwork{2, {stripes}});
    document = applied(document, RenamePaint{"Solid-Red-2", "Monza"});
    ASSERT_EQ(document.paints.size(), 1u);
    EXPECT_EQ(document.paints[0].name, "Monza");
    EXPECT_EQ(worn(document, 4, "body"), "Monza");
    EXPECT_EQ(worn(document, 1, "trim"), "Monza");
    EXPECT_EQ(document.looks[1].look.artwork.at(0).paint, "Monza");
    EXPECT_EQ(find_paint(document, "monza").diffuse, some_paint().diffuse);
    // Its own name in other letters.
    EXPECT_EQ(applied(document, RenamePaint{"Monza", "MONZA"}).paints[0].name, "MONZA");
}

TEST(RenamePaint, RefusesWhatCannotBe) {
    const Document document = applied(car(), EditPaint{4, "body", some_paint()});
    const auto refused = [&](const char* paint, const char* name) {
        return message_of([&] { applied(document, RenamePaint{paint, name}); });
    };
    EXPECT_EQ(refused("solid red", "Monza"),
              "\"solid red\" is no paint of the session's own; there are solid red 2");
    EXPECT_EQ(refused("solid red 2", "Solid Blue"),
              "there is a paint \"Solid Blue\" already; expected another name");
    EXPECT_EQ(refused("solid red 2", ""), "the paint's name is empty");
    EXPECT_EQ(message_of([&] {
                  applied(car(), RenamePaint{"x", "y"});
              }),
              "\"x\" is no paint of the session's own; there is none");
}

TEST(EditPaint, RefusesWhatNoPaintIs) {
    const auto edit = [](auto change) {
        Material paint = some_paint();
        change(paint);
        return refusal(EditPaint{1, "body", paint});
    };
    EXPECT_EQ(edit([](Material& m) { m.name = " "; }), "the paint's name is empty");
    EXPECT_NE(edit([](Material& m) { m.diffuse.x = kNan; }).find("diffuse"), std::string::npos);
    EXPECT_NE(edit([](Material& m) { m.diffuse.x = 1.5; }).find("diffuse"), std::string::npos);
    EXPECT_NE(edit([](Material& m) { m.alpha.y = 1e-9; }).find("alpha"), std::string::npos);
    EXPECT_NE(edit([](Material& m) { m.coat_f0 = 0.5; }).find("coat_f0"), std::string::npos);
    EXPECT_EQ(edit([](Material& m) { m.provenance = "\xc3"; }),
              "the paint's provenance is not UTF-8 text");
}

TEST(Looks, AreAddedWithNamesAndNumbersOfTheirOwn) {
    Document document = applied(car(), DuplicateLook{2});
    ASSERT_EQ(document.looks.size(), 5u);
    EXPECT_EQ(document.looks[4].id, 5) << "last: the others keep their number keys";
    EXPECT_EQ(document.looks[4].look.name, "silver metallic 2");
    document = applied(document, DuplicateLook{5});
    EXPECT_EQ(document.looks[5].look.name, "silver metallic 3");
    Look look = car().looks[0].look;
    look.exposure_ev = 3.0;
    document = applied(document, AddLook{look, 0});
    EXPECT_EQ(document.looks[0].id, 7);
    EXPECT_EQ(document.looks[0].look.name, "blue metallic 2");
    EXPECT_EQ(document.looks[0].look.exposure_ev, 0.0);
    EXPECT_EQ(document.next_look_id, 8);
    document = applied(applied(document, DeleteLook{7}), AddLook{look});
    EXPECT_EQ(document.looks.back().id, 8) << "a number is used once";

    look.name = "RAL 3020";
    document = applied(applied(document, AddLook{look}), AddLook{look});
    EXPECT_EQ(document.looks.back().look.name, "RAL 3020 2");
}

TEST(Looks, FromAFileKeepWhatLiesBesideIt) {
    const TemporaryFolder folder;
    write_material_file(folder / "own.json", some_paint());
    const auto file = folder.write(
        "look.json", R"({"format_version": 1, "name": "dusk", "parts": {"body": "own.json"}})");
    const AddLook command{read_look_file(file)};
    const Document document = testing::applied_with_files(car(), command);
    EXPECT_EQ(worn(document, 5, "body"), (folder / "own.json").string());
    EXPECT_TRUE(document.looks.back().look.file.empty());
    const SessionCommand back = parse_session_command(text_of(command), "a test");
    EXPECT_EQ(text_of(applied(document, back)), text_of(applied(document, command)));
}

TEST(Looks, MoveToTheirPlace) {
    const auto order = [](int look, int to) {
        std::string ids;
        for (const auto& one : applied(car(), MoveLook{look, to}).looks) {
            ids += std::to_string(one.id);
        }
        return ids;
    };
    EXPECT_EQ(order(1, 3), "2341");
    EXPECT_EQ(order(4, 0), "4123");
    EXPECT_EQ(order(2, 2), "1324");
    EXPECT_EQ(order(3, 2), "1234");
}

TEST(Looks, RefuseWhatCannotBe) {
    EXPECT_EQ(refusal(MoveLook{1, 4}), "the place is 4; expected 0 to 3");
    EXPECT_EQ(refusal(AddLook{car().looks[0].look, 5}),
              "the place is 5; expected 0 to 4, or -1 for the last");
    EXPECT_EQ(refusal(RenameLook{1, ""}), "the look's name is empty");
    EXPECT_EQ(refusal(RenameLook{1, "a\nb"}), "the look's name contains a control character");
    EXPECT_EQ(refusal(RenameLook{1, std::string(300, 'x')}),
              "the look's name has 300 bytes; at most 200 are possible");
    EXPECT_EQ(refusal(RenameLook{1, "solid red"}),
              "there is a look \"solid red\" already; expected another name");
    EXPECT_EQ(text_of(applied(car(), RenameLook{1, "blue metallic"})), text_of(car()));
    Document last = car();
    while (last.looks.size() > 1) last = applied(last, DeleteLook{last.looks[0].id});
    EXPECT_EQ(refusal(DeleteLook{4}, last),
              "\"solid red\" is the last look; a session keeps at least one");
    Look unknown = car().looks[0].look;
    unknown.parts["sails"] = "solid red";
    EXPECT_NE(refusal(AddLook{unknown}).find("no part \"sails\""), std::string::npos);
}

TEST(Lighting, IsSharedByAllLooks) {
    const DirectionalLight light{{0.0, 0.0, 2.0}, {1.0, 0.5, 0.25}, 0.1};
    Document document = applied(car(), SetLights{2, {light}});
    EXPECT_EQ(document.looks[1].look.lights[0].direction, glm::dvec3(0, 0, 1));
    document = applied(document, SetEnvironment{2, {}});
    document = applied(document, ShareLighting{2});
    for (const SessionLook& look : document.looks) {
        ASSERT_EQ(look.look.lights.size(), 1u);
        EXPECT_EQ(look.look.lights[0].radiance_rec709, light.radiance_rec709);
        EXPECT_TRUE(look.look.environment.file.empty());
    }
    EXPECT_EQ(document.looks[0].look.parts, car().looks[0].look.parts);
}

TEST(Lighting, RefusesWhatIsNoLight) {
    const auto light = [](const DirectionalLight& one) { return refusal(SetLights{1, {one}}); };
    EXPECT_EQ(light({{0, 0, 0}, {1, 1, 1}, 0}),
              "a light's direction is [0, 0, 0]; expected a finite vector with a length");
    EXPECT_NE(light({{kNan, 0, 0}, {1, 1, 1}, 0}).find("direction is [nan"), std::string::npos);
    EXPECT_EQ(light({{1, 0, 0}, {1, kInfinity, 1}, 0}),
              "a light's radiance is inf; expected a number from -1000000 to 1000000");
    EXPECT_NE(light({{1, 0, 0}, {1, 1, 1}, -1}).find("angle_rad is -1"), std::string::npos);
    EXPECT_TRUE(says(refusal(SetEnvironment{1, {"no such.hdr", 0, 1}}), "no such.hdr"));
    const std::string studio = "assets/environments/studio.hdr";
    EXPECT_TRUE(says(refusal(SetEnvironment{1, {studio, kNan, 1}}), "rotation_rad is nan"));
    EXPECT_NE(refusal(SetEnvironment{1, {studio, 0, -1}}).find("scale is -1"), std::string::npos);
}

TEST(Settings, RefuseWhatCannotBe) {
    EXPECT_EQ(refusal(SetExposure{kNan}), "the exposure is nan; expected a number from -30 to 30");
    EXPECT_NE(refusal(SetExposure{1e300}).find("1e+300"), std::string::npos);
    EXPECT_NE(refusal(SetEye{{0, kInfinity, 0}}).find("the eye is inf"), std::string::npos);
    EXPECT_NE(refusal(SetDesignWhite{101}).find("percentile is 101"), std::string::npos);
    EXPECT_NE(refusal(SetBench{"no such bench"}).find("no such bench"), std::string::npos);
    EXPECT_EQ(refusal(SetCalibration{"/nowhere"}),
              "there is no calibration.json in /nowhere; expected a calibration's folder");
}

TEST(CommandText, SaysWhichFieldIsWrong) {
    const auto read = [](const std::string& text) {
        return [=] { parse_session_command(text, "--command"); };
    };
    EXPECT_TRUE(fails_with(read(""), {"--command: found an empty file"}));
    EXPECT_TRUE(fails_with(read("{\"set-"), {"--command: line 1, column 6", "not JSON"}));
    EXPECT_TRUE(fails_with(read("[]"), {"--command: found array, expected a JSON object"}));
    EXPECT_TRUE(fails_with(read("{}"), {"found 0 members, expected one: the command's name"}));
    EXPECT_TRUE(fails_with(read(R"({"set-sail": {}})"),
                           {"found the command \"set-sail\"", "set-paint, paint-product"}));
    EXPECT_TRUE(fails_with(read(R"({"set-eye": 3})"), {"set-eye: found 3, expected an object"}));
    EXPECT_TRUE(fails_with(read(R"({"set-paint": {"look": 1, "part": "body"}})"),
                           {"set-paint.paint: found nothing"}));
    EXPECT_TRUE(fails_with(read(R"({"set-paint": {"look": 1.5, "part": "a", "paint": "b"}})"),
                           {"set-paint.look: found 1.5, expected a whole number"}));
    EXPECT_TRUE(fails_with(read(R"({"set-paint": {"look": 1e10, "part": "a", "paint": "b"}})"),
                           {"set-paint.look"}));
    EXPECT_TRUE(fails_with(read(R"({"set-exposure": {"ev": NaN}})"), {"not JSON"}));
    EXPECT_TRUE(fails_with(read(R"({"set-exposure": {"ev": 1e999}})"), {"--command", "1e999"}));
    EXPECT_TRUE(fails_with(read(R"({"set-exposure": {"ev": "1"}})"),
                           {"set-exposure.ev: found \"1\", expected a number"}));
    EXPECT_TRUE(fails_with(read(R"({"set-exposure": {"ev": 1, "unit": "EV"}})"),
                           {"unknown field \"unit\"", "only ev"}));
    EXPECT_TRUE(fails_with(read(R"({"set-quality": {"quality": "best"}})"),
                           {"set-quality.quality", "draft, normal, high or reference"}));
    EXPECT_TRUE(fails_with(read(R"({"set-eye": {"eye_mm": [1, 2]}})"),
                           {"set-eye.eye_mm: found 2 elements, expected 3 numbers"}));
    EXPECT_TRUE(fails_with(read("{\"set-eye\": " + std::string(100'000, '[')),
                           {"brackets inside one another, expected at most 200"}));
    EXPECT_TRUE(fails_with(
        read(
            R"({"edit-paint": {"look": 1, "part": "a", "material": {"name": "x", "model": "y"}}})"),
        {"edit-paint.material.model", "one of lambert, eon, "}));
}

}  // namespace
}  // namespace livery
