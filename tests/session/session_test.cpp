// The session: its document, its history without end, and that all of it comes back.

#include "session/session.h"

#include <clocale>
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/json.h"
#include "scene/library.h"
#include "session/session_file.h"
#include "session/session_script.h"
#include "support/bad_disk.h"
#include "support/file_error.h"
#include "support/memory_folder.h"
#include "support/temporary_folder.h"
#include "support/thorough.h"

namespace livery {
namespace {

using testing::car;
using testing::random_command;
using testing::state_of;

TEST(NewDocument, HoldsTheShippedLooksAsTheDefaultBenchSeesThem) {
    const Document& document = car();
    ASSERT_EQ(document.looks.size(), 4u);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(document.looks[k].id, static_cast<int>(k) + 1);
        EXPECT_EQ(document.looks[k].look.exposure_ev, 0.0);
        EXPECT_TRUE(document.looks[k].look.file.empty());
    }
    EXPECT_EQ(document.next_look_id, 5);
    EXPECT_EQ(document.exposure_ev, -0.15);
    EXPECT_EQ(document.eye_mm, glm::dvec3(281, 425, 696));
}

TEST(NewDocument, PaintsAllOfAProductThatIsNoCar) {
    const Document document = new_document("sphere");
    EXPECT_EQ(document.bench, "sphere");
    const auto product = find_product("sphere");
    const Scene scene = scene_of(document, 4, product);
    for (const Material& material : scene.part_materials) EXPECT_EQ(material.name, "solid red");
    EXPECT_THROW(new_document("boat"), FileError);
}

TEST(NewDocument, KeepsTheUnitThatSomebodySaid) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n").string();
    const Document document = new_document(file, LengthUnit::cm);
    EXPECT_EQ(document.product, file);
    EXPECT_EQ(parse_document(text_of(document), "a").product_unit, LengthUnit::cm);
    const auto product = find_product(document.product, document.product_unit);
    EXPECT_EQ(product->mesh.positions_mm[1], glm::vec3(90, 0, 0));
    EXPECT_EQ(scene_of(document, 4, product).part_materials[0].name, "solid red");

    EXPECT_EQ(text_of(car()).find("product_unit"), std::string::npos);
    Json json = Json::parse(text_of(document));
    json["product_unit"] = "ell";
    EXPECT_TRUE(fails_with([&] { parse_document(json.dump(), "a"); },
                           {"product_unit: found \"ell\", expected mm, cm, m or in"}));
    EXPECT_TRUE(fails_with([] { find_product("car", LengthUnit::m); },
                           {"car: unit: found m, expected none for a shipped product"}));
}

TEST(SceneOf, WearsTheSessionsOwnPaints) {
    const auto product = find_product("car");
    Document document = applied(car(), EditPaint{4, "body", testing::some_paint()});
    document = applied(document, SetExposure{1.5});
    const Scene first = scene_of(document, 4, product);
    const auto body = static_cast<std::size_t>(part_index(*product, "body"));
    EXPECT_EQ(first.part_materials[body].name, "solid red 2");
    EXPECT_EQ(first.part_materials[body].diffuse, testing::some_paint().diffuse);
    EXPECT_EQ(first.exposure_ev, 1.5);
    EXPECT_EQ(first.eye_in_world_mm, document.eye_mm);
    const Scene second = scene_of(document, 1, product, first.environment);
    EXPECT_EQ(second.environment, first.environment);
    EXPECT_THROW(scene_of(document, 99, product), std::invalid_argument);
}

TEST(Session, KeepsEverythingOverAReopening) {
    const TemporaryFolder folder;
    const auto file = folder / "Größe und Länge.livery";
    std::string last;
    {
        Session session = Session::open(file);
        EXPECT_FALSE(session.can_undo());
        session.execute(SetPaint{1, "body", "Solid-Red"});
        session.execute(DeleteLook{2});
        EXPECT_EQ(session.undo_label(), "Delete look silver metallic");
        EXPECT_EQ(session.undo(), 2);
        EXPECT_EQ(session.redo_label(), "Delete look silver metallic");
        session.set_workspace("look", "3");
        session.set_workspace("fenster", "größer, 1 1/2");
        EXPECT_EQ(session.save_problem(), std::nullopt);
        EXPECT_EQ(session.file(), file);
        last = text_of(session.document());
    }
    Session session = Session::open(file);
    EXPECT_EQ(text_of(session.document()), last);
    EXPECT_EQ(session.undo_label(), "Paint body solid red");
    EXPECT_EQ(session.redo_label(), "Delete look silver metallic");
    EXPECT_EQ(session.workspace(), (Workspace{{"look", "3"}, {"fenster", "größer, 1 1/2"}}));
    EXPECT_EQ(session.undo(), 1);
    EXPECT_EQ(text_of(session.document()), text_of(car()));
    EXPECT_FALSE(session.can_undo());
    EXPECT_EQ(session.undo(), std::nullopt);
    EXPECT_EQ(session.undo_label(), "");
}

TEST(Session, GoesOnUnderAnotherName) {
    const TemporaryFolder folder;
    const auto before = folder / "a.livery", after = folder / "b ü.livery";
    {
        Session session = Session::open(before);
        session.execute(SetExposure{1.0});
        session.execute(SetExposure{2.0});
        session.undo();
        session.set_workspace("look", "3");
        session.save_as(after);
        EXPECT_EQ(session.file(), after);
        EXPECT_EQ(session.redo_label(), "Set exposure to 2 EV");
        session.redo();
        session.execute(SetExposure{3.0});
        // The one before is free again.
        EXPECT_EQ(Session::open(before).document().exposure_ev, 1.0);
        EXPECT_THROW(Session::open(after), Refused);
    }
    Session session = Session::open(after);
    EXPECT_EQ(session.document().exposure_ev, 3.0);
    EXPECT_EQ(session.workspace(), (Workspace{{"look", "3"}}));
    for (int steps = 0; steps < 3; ++steps) session.undo();
    EXPECT_EQ(text_of(session.document()), text_of(car()));
    EXPECT_FALSE(session.can_undo());
}

TEST(Session, UnsavedIsSavedUnderAName) {
    const TemporaryFolder folder;
    Session session = Session::unsaved(car(), "no space left");
    session.execute(SetExposure{1.0});
    EXPECT_THROW(session.save_as(folder / "no such folder" / "a.livery"), FileError);
    folder.write("taken.livery", "somebody's");
    EXPECT_THROW(session.save_as(folder / "taken.livery"), Refused);
    EXPECT_EQ(session.save_problem(), "no space left");
    EXPECT_EQ(session.file(), std::nullopt);
    session.save_as(folder / "a.livery");
    EXPECT_EQ(session.save_problem(), std::nullopt);
    session.execute(SetExposure{2.0});
    session = Session::unsaved(car(), "closed");
    EXPECT_EQ(Session::open(folder / "a.livery").document().exposure_ev, 2.0);
}

TEST(Session, GoesOnSavingWhenThereIsRoomAgain) {
    const TemporaryFolder folder;
    Session session = Session::open(folder / "a.livery");
    EXPECT_TRUE(session.save_again()) << "nothing is in the way";
    std::optional<std::string> problem;
    bool again = true;
    {
        const FullDisk full(1);
        session.execute(SetExposure{1.0});
        session.execute(SetExposure{2.0});
        problem = session.save_problem();
        again = session.save_again();
    }
    EXPECT_TRUE(problem);
    EXPECT_FALSE(again);
    EXPECT_EQ(session.document().exposure_ev, 2.0);
    // Without a change in between.
    EXPECT_TRUE(session.save_again());
    EXPECT_EQ(session.save_problem(), std::nullopt);
    SessionFile file(folder / "a.livery", SessionFile::Access::read);
    EXPECT_EQ(file.document(file.position()).exposure_ev, 2.0);
    EXPECT_EQ(file.last_step(), 2);

    Session nowhere = Session::unsaved(car(), "a test");
    EXPECT_FALSE(nowhere.save_again()) << "there is no file to save in";
}

TEST(Session, LeavesOneFileBehind) {
    const TemporaryFolder folder;
    { Session::open(folder / "a.livery").execute(SetExposure{1.0}); }
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        names.push_back(entry.path().filename().string());
    }
    EXPECT_EQ(names, std::vector<std::string>{"a.livery"});
}

TEST(Session, ShowsTheLookThatAStepWasAbout) {
    Session session = Session::unsaved(car(), "a test");
    session.execute(DuplicateLook{2});
    EXPECT_EQ(session.undo(), std::nullopt) << "it is gone";
    EXPECT_EQ(session.redo(), 5);
    session.execute(SetPaint{3, "body", "solid blue"});
    EXPECT_EQ(session.undo(), 3);
    EXPECT_EQ(session.redo(), 3);
    session.execute(SetExposure{2.0});
    EXPECT_EQ(session.undo(), std::nullopt);
}

TEST(Session, RevisionGrowsWithChangesOnly) {
    Session session = Session::unsaved(car(), "a test");
    const auto first = session.revision();
    session.execute(SetPaint{4, "body", "solid red"});
    EXPECT_EQ(session.revision(), first) << "it wore that already";
    EXPECT_FALSE(session.can_undo());
    EXPECT_THROW(session.execute(SetPaint{4, "body", "?"}), std::invalid_argument);
    EXPECT_THROW(session.execute(DeleteLook{9}), std::invalid_argument);
    EXPECT_EQ(session.revision(), first);
    EXPECT_EQ(text_of(session.document()), text_of(car()));
    session.execute(SetPaint{4, "body", "solid blue"});
    session.undo();
    session.redo();
    EXPECT_EQ(session.revision(), first + 3);
}

TEST(Session, NewCommandDropsWhatCouldBeRedone) {
    const TemporaryFolder folder;
    Session session = Session::open(folder / "a.livery");
    session.execute(SetExposure{1.0});
    session.execute(SetExposure{2.0});
    session.undo();
    session.execute(SetExposure{3.0});
    EXPECT_FALSE(session.can_redo());
    EXPECT_EQ(session.redo(), std::nullopt);
    session.undo();
    EXPECT_EQ(session.document().exposure_ev, 1.0);
    EXPECT_EQ(session.redo_label(), "Set exposure to 3 EV");
}

TEST(Session, UnsavedSaysWhyAndWorks) {
    Session session = Session::unsaved(car(), "the folder is read-only");
    session.execute(SetExposure{1.0});
    session.set_workspace("look", "1");
    EXPECT_EQ(session.save_problem(), "the folder is read-only");
    EXPECT_EQ(session.file(), std::nullopt);
    Session moved = std::move(session);
    moved.undo();
    EXPECT_EQ(text_of(moved.document()), text_of(car()));
    EXPECT_EQ(moved.workspace().at("look"), "1");
}

TEST(Session, DefaultOneLiesInTheUsersFolderAndMakesIt) {
    const TemporaryFolder folder;
    const char* home = std::getenv("LIVERY_HOME");
    const std::string before = home ? home : "";
    ::setenv("LIVERY_HOME", (folder / "a home").c_str(), 1);
    EXPECT_EQ(default_session_file(), folder / "a home" / "sessions" / "default.livery");
    { Session::open(default_session_file()); }
    EXPECT_TRUE(std::filesystem::exists(folder / "a home" / "sessions" / "default.livery"));
    if (home) {
        ::setenv("LIVERY_HOME", before.c_str(), 1);
    } else {
        ::unsetenv("LIVERY_HOME");
    }
}

/// 2,000 random commands with undo, redo and reopening in between, against the list of all
/// documents; then all the way back and all the way forth.
TEST(Session, UndoesAndRedoesRandomCommandsExactly) {
    constexpr std::uint64_t kSeed = 1;
    const int kCommands = thorough() ? 2000 : 500;
    const TemporaryFolder folder(memory_folder());
    const auto file = folder / "long.livery";
    Session session = Session::open(file);
    std::vector<std::string> states = {text_of(session.document())};
    std::size_t at = 0;
    Random random(kSeed);
    int refused = 0, reopened = 0, deleted = 0;
    for (int k = 0; k < kCommands; ++k) {
        SCOPED_TRACE("seed " + std::to_string(kSeed) + ", command " + std::to_string(k));
        const SessionCommand command = random_command(random, session.document());
        try {
            session.execute(command);
            deleted += std::holds_alternative<DeleteLook>(command) ? 1 : 0;
            if (const std::string now = text_of(session.document()); now != states[at]) {
                states.resize(++at);
                states.push_back(now);
            }
        } catch (const std::invalid_argument&) {
            ++refused;
        }
        if (random.below(20) == 0) {
            for (auto steps = random.below(6); steps > 0 && at > 0; --steps, --at) session.undo();
        }
        if (random.below(20) == 0) {
            for (auto steps = random.below(6); steps > 0 && at + 1 < states.size(); --steps, ++at) {
                session.redo();
            }
        }
        if (random.below(200) == 0) {
            session = Session::unsaved(car(), "closed");
            session = Session::open(file);
            ++reopened;
        }
        ASSERT_EQ(session.save_problem(), std::nullopt);
        ASSERT_EQ(text_of(session.document()), states[at]);
        ASSERT_EQ(session.can_undo(), at > 0);
        ASSERT_EQ(session.can_redo(), at + 1 < states.size());
    }
    while (session.can_redo()) session.redo();
    at = states.size() - 1;
    ASSERT_EQ(text_of(session.document()), states[at]);
    while (session.can_undo()) {
        session.undo();
        ASSERT_EQ(text_of(session.document()), states[--at]);
    }
    EXPECT_EQ(at, 0u);
    EXPECT_EQ(states[0], text_of(car()));
    while (session.can_redo()) {
        session.redo();
        ASSERT_EQ(text_of(session.document()), states[++at]);
    }
    EXPECT_EQ(at + 1, states.size());
    EXPECT_GT(states.size(), static_cast<std::size_t>(kCommands) / 4);
    EXPECT_GT(refused, kCommands / 100);
    EXPECT_GT(deleted, kCommands / 40);
    session = Session::unsaved(car(), "closed");
    std::cout << "    seed " << kSeed << ": " << states.size() - 1 << " steps kept, " << refused
              << " refused, " << deleted << " looks deleted, " << reopened << " times reopened, "
              << std::filesystem::file_size(file) / (states.size() - 1) << " bytes a step\n";
}

}  // namespace
}  // namespace livery
