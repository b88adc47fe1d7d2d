// Seats and whose eye it is, as part of a session: commands, undo, files from before there were
// any.

#include <gtest/gtest.h>

#include "core/json.h"
#include "scene/library.h"
#include "session/session.h"
#include "session/some_commands.h"
#include "support/file_error.h"
#include "support/message_of.h"

namespace livery {
namespace {

using testing::car;

const EyeSeat kLeft{1, {-400.0, 480.0, 900.0}}, kRight{2, {400.0, 480.0, 900.0}};

Document seated() { return applied(car(), SetSeats{{kRight, kLeft}}); }

glm::dvec3 drawn_for(const Document& document) {
    static const auto product = find_product("car");
    return scene_of(document, document.looks.front().id, product).eye_in_world_mm;
}

TEST(SessionSeats, LooksAreDrawnForTheEyeInUse) {
    const Document before = seated();
    EXPECT_EQ(before.seats, (std::vector<EyeSeat>{kLeft, kRight})) << "by number";
    EXPECT_EQ(drawn_for(before), car().eye_mm) << "seats alone change nothing";
    const Document of_one = applied(before, UseEye{{EyeSource::seat, 2}});
    EXPECT_EQ(drawn_for(of_one), kRight.eye_mm);
    const Document of_all = applied(of_one, UseEye{{EyeSource::mean, 0}});
    EXPECT_EQ(drawn_for(of_all), glm::dvec3(0.0, 480.0, 900.0));
    // It follows its seats.
    const Document moved = applied(of_all, SetSeat{2, {600.0, 480.0, 900.0}});
    EXPECT_EQ(drawn_for(moved), glm::dvec3(100.0, 480.0, 900.0));
    const Document without = applied(moved, SetSeat{2, {600.0, 480.0, 900.0}, false});
    EXPECT_EQ(drawn_for(without), kLeft.eye_mm);
    // The point that was set by hand is kept meanwhile.
    EXPECT_EQ(drawn_for(applied(without, UseEye{})), car().eye_mm);
    const Document by_hand = applied(of_all, SetEye{{1.0, 2.0, 3.0}});
    EXPECT_EQ(drawn_for(by_hand), glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(by_hand.eye_choice, EyeChoice{});
}

TEST(SessionSeats, AnEyeWhoseSeatGoesStaysWhereItWas) {
    const Document of_one = applied(seated(), UseEye{{EyeSource::seat, 2}});
    const Document gone = applied(of_one, RemoveSeat{2});
    EXPECT_EQ(gone.eye_choice, EyeChoice{});
    EXPECT_EQ(drawn_for(gone), kRight.eye_mm);
    const Document of_all = applied(seated(), UseEye{{EyeSource::mean, 0}});
    EXPECT_EQ(drawn_for(applied(of_all, SetSeats{})), glm::dvec3(0.0, 480.0, 900.0));
    const Document one = applied(of_all, RemoveSeat{1});
    EXPECT_EQ(drawn_for(one), kRight.eye_mm) << "the mean of those that are left";
    const Document none_counts = applied(one, SetSeat{2, kRight.eye_mm, false});
    EXPECT_EQ(none_counts.eye_choice, EyeChoice{});
    EXPECT_EQ(drawn_for(none_counts), kRight.eye_mm);
}

TEST(SessionSeats, WhatCannotBeIsRefusedAndNothingChanges) {
    const auto refused = [](const SessionCommand& command) {
        return message_of([&] { applied(seated(), command); });
    };
    EXPECT_TRUE(says(refused(SetSeat{3, {410.0, 480.0, 900.0}}), "seats 2 and 3 are 10 mm apart"));
    EXPECT_NE(refused(SetSeat{0, {0.0, 0.0, 0.0}}).find("number is 0"), std::string::npos);
    EXPECT_NE(refused(RemoveSeat{5}).find("there is no seat 5"), std::string::npos);
    EXPECT_NE(refused(UseEye{{EyeSource::seat, 5}}).find("there is no seat 5"), std::string::npos);
    EXPECT_NE(refused(SetSeats{{kLeft, kLeft}}).find("two seats 1"), std::string::npos);
    EXPECT_NE(message_of([] {
                  applied(car(), UseEye{{EyeSource::mean, 0}});
              }).find("no seat counts"),
              std::string::npos);
}

TEST(SessionSeats, LabelsSayWhatUndoTakesBack) {
    const Document before = seated();
    EXPECT_EQ(label_of(before, SetSeat{3, {0.0, 480.0, 900.0}}), "Add seat 3");
    EXPECT_EQ(label_of(before, SetSeat{1, {0.0, 480.0, 900.0}}), "Move seat 1");
    EXPECT_EQ(label_of(before, SetSeat{1, kLeft.eye_mm, false}), "Leave seat 1 out");
    EXPECT_EQ(label_of(before, RemoveSeat{1}), "Remove seat 1");
    EXPECT_EQ(label_of(before, SetSeats{{kLeft}}), "Place 1 seat");
    EXPECT_EQ(label_of(before, UseEye{{EyeSource::mean, 0}}),
              "Draw for the eye in the mean of 2 seats");
}

TEST(SessionSeats, AreReadAsWrittenAndUndone) {
    Session session = Session::unsaved(car(), "a test");
    session.execute(SetSeats{{kLeft, {2, kRight.eye_mm, false}}});
    session.execute(UseEye{{EyeSource::seat, 1}});
    const std::string text = text_of(session.document());
    EXPECT_EQ(text_of(parse_document(text, "again")), text);
    EXPECT_EQ(Json::parse(text)["format_version"], 2);
    session.undo();
    EXPECT_EQ(drawn_for(session.document()), car().eye_mm);
    session.undo();
    EXPECT_TRUE(session.document().seats.empty());
    session.redo();
    session.redo();
    EXPECT_EQ(text_of(session.document()), text);
}

TEST(SessionSeats, WithoutAnyTheTextIsAsItWasBeforeThereWereAny) {
    const Json json = Json::parse(text_of(car()));
    EXPECT_EQ(json["format_version"], 1);
    EXPECT_FALSE(json.contains("seats"));
    EXPECT_FALSE(json.contains("eye_of"));
    const Document read = parse_document(json.dump(), "an old session");
    EXPECT_TRUE(read.seats.empty());
    EXPECT_EQ(eye_in_use_mm(read), car().eye_mm);
}

TEST(SessionSeats, MistakesInAFileAreToldWithTheirField) {
    const auto mistake = [](const char* seats, const char* eye_of) {
        Json json = Json::parse(text_of(seated()));
        json["seats"] = Json::parse(seats);
        json["eye_of"] = Json::parse(eye_of);
        return message_of([&] { parse_document(json.dump(), "s.livery"); });
    };
    const char* hand = R"({"of": "hand"})";
    const std::string twice =
        mistake(R"([{"seat": 1, "eye_mm": [0, 0, 0]}, {"seat": 1, "eye_mm": [900, 0, 0]}])", hand);
    EXPECT_NE(twice.find("seats[1]"), std::string::npos) << twice;
    EXPECT_NE(twice.find("two seats 1"), std::string::npos) << twice;
    EXPECT_TRUE(says(mistake(R"([{"seat": 1, "eye_mm": [0, 0]}])", hand), "eye_mm"));
    EXPECT_TRUE(says(mistake(R"([{"seat": 1, "eye_mm": [0, 0, 2e6]}])", hand), "eye_mm"));
    EXPECT_NE(mistake("[]", R"({"of": "mean"})").find("eye_of"), std::string::npos);
    EXPECT_NE(mistake("[]", R"({"of": "seat", "seat": 1})").find("no seat 1"), std::string::npos);
    EXPECT_NE(mistake("[]", R"({"of": "mean", "seat": 1})").find("seat"), std::string::npos);
    EXPECT_NE(mistake("[]", R"({"of": "all"})").find("eye_of.of"), std::string::npos);
}

}  // namespace
}  // namespace livery
