// A session's file when something is wrong with it, with the disk, or with somebody else.

#include "session/session_file.h"

#include <fstream>
#include <optional>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "appearance/measured/measured_paint.h"
#include "core/database.h"
#include "jobs/file_check.h"
#include "session/session.h"
#include "session/some_commands.h"
#include "support/bad_disk.h"
#include "support/file_error.h"
#include "support/memory_folder.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

using testing::car;
using Path = std::filesystem::path;

constexpr std::int32_t kApplicationId = 0x4c765331;

Path saved_session(const TemporaryFolder& folder, const std::string& name, int steps = 2) {
    const auto file = folder / name;
    Session session = Session::open(file);
    for (int k = 0; k < steps; ++k) session.execute(SetExposure{0.5 + 0.01 * k});
    return file;
}

/// A session whose file was changed by that statement.
Path spoilt(const TemporaryFolder& folder,
            const std::string& sql,
            const std::vector<DatabaseValue>& values = {}) {
    static int count = 0;
    const auto file = saved_session(folder, "spoilt " + std::to_string(++count) + ".livery");
    Database(file, Database::Mode::existing, kApplicationId, 1).run(sql, values);
    return file;
}

/// The newest document with one piece of its text replaced.
Path with_document(const TemporaryFolder& folder, const std::string& old, const std::string& text) {
    std::string document = text_of(applied(car(), SetExposure{0.51}));
    const auto at = document.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    document.replace(at, old.size(), text);
    return spoilt(folder, "UPDATE step SET document = ?1 WHERE number = 2", {document});
}

/// Both the program and `livery check` say it.
::testing::AssertionResult refused(const Path& file,
                                   std::initializer_list<std::string_view> parts) {
    const auto opened = fails_with([&] { Session::open(file); }, parts);
    if (!opened) return opened;
    const FileCheck check = check_file(file);
    if (check.ok()) return ::testing::AssertionFailure() << "livery check finds nothing wrong";
    for (const auto part : parts) {
        if (check.problems[0].find(part) == std::string::npos) {
            return ::testing::AssertionFailure() << "livery check says " << check.problems[0];
        }
    }
    return opened;
}

TEST(SessionFile, OfAnotherKindIsRefusedByName) {
    const TemporaryFolder folder;
    EXPECT_TRUE(fails_with([&] { Session::open(folder / "no folder/a.livery"); },
                           {"no folder/a.livery: found no way to write beside it (No such file",
                            "expected a folder that is there"}));
    EXPECT_FALSE(std::filesystem::exists(folder / "no folder"));
    EXPECT_TRUE(refused(folder.write("empty.livery", ""), {"empty.livery: found an empty file"}));
    EXPECT_TRUE(refused(folder.write("text.livery", std::string(9000, 'x')),
                        {"text.livery: found a file that is not a database"}));
    EXPECT_TRUE(fails_with([&] { Session::open(folder.path()); }, {"found a folder"}));
    const auto other = folder / "other.livery";
    { Database(other, Database::Mode::create, 0x4c765642, 1).run("CREATE TABLE t (x)"); }
    EXPECT_TRUE(refused(other, {"other.livery: application_id: found 0x4c765642", "0x4c765331"}));
    const auto newer = saved_session(folder, "newer.livery");
    { Database(newer, Database::Mode::existing, kApplicationId, 1).set_version(2); }
    EXPECT_TRUE(refused(newer, {"user_version: found 2 (written by a newer Livery)"}));
    const auto nothing = folder / "nothing.livery";
    { const Database database(nothing, Database::Mode::create, kApplicationId, 1); }
    EXPECT_TRUE(refused(nothing, {"user_version: found 0, nothing written yet"}));
}

TEST(SessionFile, DamagedIsRefusedAndStaysAsItIs) {
    const TemporaryFolder folder;
    const auto truncated = saved_session(folder, "truncated.livery", 40);
    const auto size = std::filesystem::file_size(truncated);
    std::filesystem::resize_file(truncated, size / 2);
    EXPECT_TRUE(refused(truncated, {"truncated.livery: found a damaged database"}));
    EXPECT_EQ(std::filesystem::file_size(truncated), size / 2);

    const auto hole = saved_session(folder, "hole.livery", 40);
    {
        std::fstream stream(hole, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(static_cast<std::streamoff>(size / 8192 * 4096));
        stream << std::string(4096, '\xa5');
    }
    EXPECT_TRUE(refused(hole, {"hole.livery: found a damaged database"}));
    EXPECT_TRUE(
        refused(spoilt(folder, "DROP TABLE workspace"), {"another shape (no such table: work"}));
    EXPECT_TRUE(refused(spoilt(folder, "DELETE FROM step"), {"step.number"}));
    EXPECT_TRUE(refused(spoilt(folder, "DELETE FROM step WHERE number = 2"),
                        {"place.position: found 2, expected a step from 0 to 1"}));
    EXPECT_TRUE(refused(spoilt(folder, "DELETE FROM place"), {"place: found 0 rows"}));
    EXPECT_TRUE(refused(spoilt(folder, "UPDATE place SET position = -1"),
                        {"place.position: found -1, expected a step from 0 to 2"}));
    EXPECT_TRUE(refused(spoilt(folder, "UPDATE place SET position = 'x'"),
                        {"place.position: found a value of another type"}));
}

TEST(SessionFile, DocumentThatIsNoneIsRefusedByItsField) {
    const TemporaryFolder folder;
    const auto with = [&](const std::string& old, const std::string& text) {
        return with_document(folder, old, text);
    };
    const std::string exposure = "\"exposure_ev\":0.51";
    const std::string set = "UPDATE step SET document = ";
    EXPECT_TRUE(refused(spoilt(folder, set + "'garbage' WHERE number = 2"),
                        {"step 2, document, line 1, column 1: found text that is not JSON"}));
    EXPECT_TRUE(refused(spoilt(folder, set + "'{}' WHERE number = 2"),
                        {"step 2, document, format_version: found nothing"}));
    EXPECT_TRUE(refused(with("{\"format_version\":1", "{\"format_version\":3"),
                        {"step 2, document, format_version: found 3 (written by a newer Livery)"}));
    EXPECT_TRUE(refused(with(exposure, "\"exposure_ev\":NaN"), {"not JSON"}));
    EXPECT_TRUE(refused(with(exposure, "\"exposure_ev\":1e999"), {"step 2, document", "1e999"}));
    EXPECT_TRUE(refused(with(exposure, "\"exposure_ev\":1e300"),
                        {"exposure_ev: found 1e+300, expected a number between -30 and 30"}));
    EXPECT_TRUE(refused(with(exposure, "\"exposure_ev\":\"bright\""),
                        {"exposure_ev: found \"bright\", expected a number"}));
    EXPECT_TRUE(refused(with(exposure, "\"exposure_ev\":0.51,\"extra\":1"),
                        {"the unknown field \"extra\""}));
    EXPECT_TRUE(refused(with("\"id\":2", "\"id\":1"), {"looks[1].id: found 1 for a second time"}));
    EXPECT_TRUE(refused(with("\"next_look_id\":5", "\"next_look_id\":4"),
                        {"next_look_id: found 4, expected more than the looks' numbers"}));
    EXPECT_TRUE(refused(with("\"next_look_id\":5", "\"next_look_id\":5000000000"),
                        {"next_look_id: found 5000000000, expected a whole number"}));
    EXPECT_TRUE(refused(with("\"quality\":\"normal\"", "\"quality\":\"best\""),
                        {"quality: found \"best\", expected draft, normal, high or reference"}));
    EXPECT_TRUE(refused(spoilt(folder, set + "?1 WHERE number = 2", {std::string(100'000, '[')}),
                        {"found 100000 brackets inside one another"}));
}

TEST(SessionFile, OldStepThatIsDamagedStopsUndoThereAndNothingElse) {
    const TemporaryFolder folder;
    const auto file = spoilt(folder, "UPDATE step SET document = 'x' WHERE number = 1");
    Session session = Session::open(file);
    const std::string before = text_of(session.document());
    EXPECT_TRUE(fails_with([&] { session.undo(); }, {"step 1, document"}));
    EXPECT_EQ(text_of(session.document()), before);
    session.execute(SetExposure{3.0});
    session.undo();
    EXPECT_EQ(text_of(session.document()), before);
    EXPECT_EQ(session.save_problem(), std::nullopt);
}

TEST(SessionFile, IsOpenInOneProgramAtATime) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery";
    const auto refusal = [&] {
        try {
            Session::open(file);
        } catch (const Refused& no) {
            return std::string(no.what());
        }
        return std::string();
    };
    {
        const Session session = Session::open(file);
        EXPECT_EQ(refusal(),
                  file.string() + " is open in another Livery (process " +
                      std::to_string(::getpid()) +
                      "); close it there, or name another session file here");
        std::filesystem::create_symlink(file, folder / "link.livery");
        EXPECT_THROW(Session::open(folder / "link.livery"), Refused);
        EXPECT_TRUE(check_file(file).ok()) << "reading is possible";
    }
    EXPECT_EQ(refusal(), "");

    // Another process that is killed leaves no lock.
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        const Session session = Session::open(file);
        if (::write(ready[1], ".", 1) != 1) ::_exit(1);
        while (true) ::pause();
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_NE(refusal().find("(process " + std::to_string(child) + ")"), std::string::npos);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(refusal(), "");
    for (const int end : ready) ::close(end);
}

TEST(SessionFile, FullDiskKeepsChangesUntilTheyCanBeSaved) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery";
    std::string last;
    {
        Session session = Session::open(file);
        session.execute(SetExposure{1.0});
        {
            const FullDisk full(100'000);
            for (int k = 0; k < 60; ++k) session.execute(SetEye{{k, k, k}});
            session.set_workspace("look", "4");
            ASSERT_NE(session.save_problem(), std::nullopt);
            EXPECT_NE(session.save_problem()->find("a.livery: found a full disk"),
                      std::string::npos);
            EXPECT_EQ(session.document().eye_mm.x, 59.0);
            for (int k = 0; k < 10; ++k) session.undo();
            EXPECT_EQ(session.document().eye_mm.x, 49.0);
            for (int k = 0; k < 5; ++k) session.redo();
            session.execute(SetExposure{2.0});
            EXPECT_FALSE(session.can_redo());
            EXPECT_NE(session.save_problem(), std::nullopt);
        }
        session.execute(SetExposure{2.5});
        EXPECT_EQ(session.save_problem(), std::nullopt);
        last = text_of(session.document());
    }
    Session session = Session::open(file);
    EXPECT_EQ(text_of(session.document()), last);
    EXPECT_EQ(session.workspace().at("look"), "4");
    int steps = 0;
    for (; session.can_undo(); ++steps) session.undo();
    EXPECT_EQ(steps, 1 + 55 + 2);
    EXPECT_EQ(text_of(session.document()), text_of(car()));
}

TEST(SessionFile, TakesNothingFromTheLogOfAFileThatIsGone) {
    const TemporaryFolder folder;
    const auto file = folder / "a.livery", log = folder / "a.livery-wal", kept = folder / "kept";
    SessionFile::create(file, {{"", "", text_of(car())}});
    {
        // As a killed program leaves it, when somebody removes the session and begins another
        Session session = Session::open(file);
        session.execute(SetExposure{2.0});
        ASSERT_GT(std::filesystem::file_size(log), 0u);
        std::filesystem::copy_file(log, kept);
    }
    std::filesystem::remove(file);
    std::filesystem::rename(kept, log);
    SessionFile::create(file, {{"", "", text_of(car())}});
    Session session = Session::open(file);
    EXPECT_FALSE(session.can_undo());
    EXPECT_EQ(text_of(session.document()), text_of(car()));
}

TEST(SessionFile, IsWholeOrNotThereWhenTheDiskIsFull) {
    const TemporaryFolder folder(memory_folder());
    const std::string document = text_of(car());
    int made = 0, failed = 0;
    for (rlim_t room = 0; room < 60'000; room += 1000) {
        const auto file = folder / "a.livery";
        try {
            const FullDisk full(room);
            SessionFile::create(file, {{"", "", document}});
            ++made;
        } catch (const FileError& error) {
            EXPECT_NE(std::string(error.what()).find("a.livery: found a full disk"),
                      std::string::npos)
                << error.what();
            EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << room;
            ++failed;
            continue;
        }
        EXPECT_EQ(text_of(Session::open(file).document()), document) << room;
        std::filesystem::remove(file);
    }
    EXPECT_GT(made, 0);
    EXPECT_GT(failed, 0);
}

TEST(SessionFile, TriesOnceMoreWhenItIsClosed) {
    const TemporaryFolder folder;
    const auto file = saved_session(folder, "a.livery");
    {
        std::optional<Session> session(Session::open(file));
        const FullDisk full(1000);
        session->undo();
        EXPECT_NE(session->save_problem(), std::nullopt);
        session.reset();
    }
    EXPECT_EQ(Session::open(file).document().exposure_ev, 0.51) << "the disk was still full";
    {
        Session session = Session::open(file);
        const FullDisk full(1000);
        session.undo();
        EXPECT_NE(session.save_problem(), std::nullopt);
    }
    EXPECT_EQ(Session::open(file).document().exposure_ev, 0.5) << "there was room again";
}

TEST(SessionFile, PaintWhoseMeasuredFileIsGoneStaysAndComesBackWithIt) {
    const TemporaryFolder folder;
    const auto panel = folder / "panel.csv", aside = folder / "aside.csv";
    std::ofstream samples(panel);
    samples << "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
    for (int k = 0; k < 12; ++k) samples << 0.1 * k << ",0," << 0.5 << ',' << k << ",.1,.05,.02\n";
    samples.close();
    Material paint;
    paint.name = "panel";
    paint.model = ReflectanceModel::measured;
    paint.measured = read_measured_paint(panel);
    const auto file = folder / "a.livery";
    std::string text;
    {
        Session session = Session::open(file);
        session.execute(EditPaint{1, "body", paint});
        text = text_of(session.document());
        EXPECT_TRUE(drawing_problems(session.document()).empty());
    }
    std::filesystem::rename(panel, aside);
    {
        Session session = Session::open(file);
        EXPECT_EQ(unread_files(session.document()), std::set{panel}) << "it was waited for";
        EXPECT_TRUE(drawing_problems(session.document()).empty()) << "nobody knows yet";
        session.use(with_paints_read(session.document()).library);
        EXPECT_TRUE(unread_files(session.document()).empty());
        const auto problems = drawing_problems(session.document());
        ASSERT_EQ(problems.size(), 1u);
        EXPECT_TRUE(problems.front().starts_with("\"panel\" is black: ")) << problems.front();
        EXPECT_NE(problems.front().find(panel.string()), std::string::npos) << problems.front();
        EXPECT_EQ(text_of(session.document()), text);
        Material edited = session.document().paints.front();
        EXPECT_THROW(session.execute(EditPaint{1, "rims", edited}), std::invalid_argument);
        session.execute(DuplicateLook{1});
        session.undo();
        session.undo();
        EXPECT_TRUE(session.document().paints.empty());
        session.redo();
        EXPECT_EQ(text_of(session.document()), text);
        EXPECT_EQ(drawing_problems(session.document()), problems) << "what is known stays";
        std::filesystem::rename(aside, panel);
        session.use(read_paint_library(session.document().library));
        EXPECT_TRUE(drawing_problems(session.document()).empty());
    }
    Session session = Session::open(file);
    session.use(with_paints_read(session.document()).library);
    EXPECT_TRUE(drawing_problems(session.document()).empty());
    EXPECT_EQ(session.document().paints.front().measured->id, paint.measured->id);
}

TEST(SessionFile, FolderThatCannotBeWrittenIsNamed) {
    const TemporaryFolder folder;
    const auto inner = folder / "read only";
    std::filesystem::create_directory(inner);
    const auto file = inner / "a.livery";
    { Session::open(file).execute(SetExposure{1.0}); }
    using std::filesystem::perms;
    std::filesystem::permissions(folder.path(), perms(0755));
    std::filesystem::permissions(inner, perms(0555));
    {
        const OrdinaryUser user;
        for (const char* name : {"a.livery", "new.livery"}) {
            EXPECT_TRUE(fails_with([&] { Session::open(inner / name); },
                                   {name, "found no way to write beside it (Permission denied)"}));
        }
        SessionFile reader(file, SessionFile::Access::read);
        EXPECT_EQ(reader.document(reader.position()).exposure_ev, 1.0);
    }
    std::filesystem::permissions(inner, perms(0755));
}

}  // namespace
}  // namespace livery
