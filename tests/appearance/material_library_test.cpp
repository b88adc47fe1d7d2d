// The user's own paints beside the shipped ones: found by name, never shadowing, never replaced.
#include "appearance/material_library.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "appearance/measured/measured_paint.h"
#include "core/error.h"
#include "core/paths.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// Each test has a home of its own.
class UsersLibrary : public ::testing::Test {
  protected:
    UsersLibrary() {
        const char* home = std::getenv("LIVERY_HOME");
        if (home) before_ = home;
        setenv("LIVERY_HOME", home_.path().c_str(), 1);
    }
    ~UsersLibrary() override {
        if (before_.empty()) {
            unsetenv("LIVERY_HOME");
        } else {
            setenv("LIVERY_HOME", before_.c_str(), 1);
        }
    }

    TemporaryFolder home_;

  private:
    std::string before_;
};

Material paint(const std::string& name) {
    Material material;
    material.name = name;
    material.family = "solid";
    material.diffuse = {0.1, 0.2, 0.3};
    return material;
}

TEST_F(UsersLibrary, IsEmptyBeforeAnythingIsSaved) {
    const PaintLibrary library = *read_paint_library();
    EXPECT_GE(library.shipped.size(), 12u);
    EXPECT_TRUE(library.users.empty());
    EXPECT_TRUE(library.problems.empty());
    EXPECT_FALSE(std::filesystem::exists(user_materials_folder()));
}

TEST_F(UsersLibrary, FindsWhatWasSaved) {
    const auto file = save_to_library(paint("Müller's Blue"));
    EXPECT_EQ(file.parent_path(), home_.path() / "materials");
    EXPECT_EQ(find_material("Müller's-blue").diffuse, glm::dvec3(0.1, 0.2, 0.3));
    const PaintLibrary library = *read_paint_library();
    ASSERT_EQ(library.users.size(), 1u);
    EXPECT_EQ(library.users[0].name, "Müller's Blue");
    EXPECT_EQ(library.users[0].file, file);
    EXPECT_TRUE(fails_with([] { find_material("müller's blau"); }, {"nearest: 'Müller's Blue'"}));
}

TEST_F(UsersLibrary, RefusesANameThatIsTaken) {
    save_to_library(paint("mine"));
    for (const char* taken : {"Mine", "solid-red"}) {
        try {
            save_to_library(paint(taken));
            ADD_FAILURE() << taken;
        } catch (const Refused& refused) {
            EXPECT_NE(refused.why().find("has a paint '"), std::string::npos) << refused.why();
            EXPECT_NE(refused.why().find(".json"), std::string::npos) << refused.why();
            EXPECT_EQ(refused.fix(), "choose another name");
        }
    }
    EXPECT_EQ(read_paint_library()->users.size(), 1u);
}

TEST_F(UsersLibrary, RefusesNamesThatAreNone) {
    const std::string too_long(121, 'a');
    for (const char* name :
         {"", "   ", "a/b", "red.json", "red.JSON", "two\nlines", too_long.c_str()}) {
        EXPECT_THROW(save_to_library(paint(name)), std::invalid_argument) << name;
    }
    Material bad = paint("bad");
    bad.diffuse = {2.0, 0.0, 0.0};
    EXPECT_THROW(save_to_library(bad), std::invalid_argument);
    EXPECT_TRUE(read_paint_library()->users.empty());
}

TEST_F(UsersLibrary, KeepsFilesThatItCannotRead) {
    std::filesystem::create_directories(user_materials_folder());
    const auto broken = home_.write("materials/mine.json", "{\"format_version\": 1");
    home_.write("materials/notes.txt", "no paint");
    const auto file = save_to_library(paint("mine"));
    EXPECT_EQ(file.filename(), "mine-2.json");
    EXPECT_EQ(read_text_file(broken), "{\"format_version\": 1");
    const PaintLibrary library = *read_paint_library();
    ASSERT_EQ(library.users.size(), 1u);
    ASSERT_EQ(library.problems.size(), 1u);
    EXPECT_NE(library.problems[0].find(broken.string()), std::string::npos);
    // Whoever looks for the broken one is told of it; the others are found.
    EXPECT_TRUE(fails_with([] { find_material("hers"); }, {"'hers'", "left out", "mine.json"}));
    EXPECT_EQ(find_material("solid red").name, "solid red");
    EXPECT_EQ(find_material("mine").name, "mine");
}

/// A grey tile of that albedo times pi.
std::string measurement(const std::string& value) {
    std::string text = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
    for (int k = 0; k < 12; ++k) {
        text += std::to_string(0.1 * k) + ",0,0.4," + std::to_string(0.5 * k) + "," + value + "," +
                value + "," + value + "\n";
    }
    return text;
}

std::string measured_paint_text(const std::string& name, const std::string& file) {
    return R"({"format_version": 1, "name": ")" + name +
           R"(", "model": "measured", "parameters": {"file": ")" + file + R"("}})";
}

using Library = std::shared_ptr<const PaintLibrary>;

TEST_F(UsersLibrary, IsTheSameWhileNothingChangesAndANewOneWhenSomethingDoes) {
    const Library before = read_paint_library();
    EXPECT_EQ(read_paint_library(before), before);
    const auto file = save_to_library(paint("mine"));
    const Library added = read_paint_library(before);
    ASSERT_NE(added, before);
    EXPECT_EQ(added->users.size(), 1u);
    EXPECT_EQ(read_paint_library(added), added);

    Material changed = paint("mine");
    changed.diffuse = {0.125, 0.25, 0.5};
    write_material_file(file, changed);
    const Library other = read_paint_library(added);
    EXPECT_EQ(other->find("mine")->diffuse, changed.diffuse);
    std::filesystem::rename(file, home_ / "materials/other.json");
    const Library moved = read_paint_library(other);
    EXPECT_EQ(moved->find("mine")->file, home_ / "materials/other.json");
    std::filesystem::remove(home_ / "materials/other.json");
    EXPECT_EQ(read_paint_library(moved)->find("mine"), nullptr);

    // What somebody holds is as it was.
    EXPECT_TRUE(before->users.empty());
    EXPECT_EQ(added->find("mine")->diffuse, paint("mine").diffuse);
    EXPECT_EQ(other->find("mine")->file, file);
}

TEST_F(UsersLibrary, ReadsWhatAPaintWasMeasuredInWhenItIsAsked) {
    std::filesystem::create_directories(user_materials_folder());
    const auto tile = home_.write("materials/tile.csv", measurement("0.2"));
    home_.write("materials/tile.json", measured_paint_text("my tile", "tile.csv"));
    const Library before = read_paint_library();
    EXPECT_TRUE(before->users.empty());
    ASSERT_EQ(before->unread.size(), 1u);
    EXPECT_FALSE(is_read(*before->find("My-Tile")));
    EXPECT_EQ(before->unread[0].measured->file, tile);

    const Library after = read_paint_library(before, {tile});
    ASSERT_EQ(after->users.size(), 1u);
    EXPECT_TRUE(after->unread.empty());
    EXPECT_TRUE(is_read(after->users[0]));
    EXPECT_EQ(before->unread.size(), 1u);
    EXPECT_EQ(read_paint_library(after, {tile}), after) << "it was read a second time";
    // Another paint leaves it in memory; another file is read.
    save_to_library(paint("mine"));
    const Library more = read_paint_library(after);
    EXPECT_EQ(more->find("my tile")->measured, after->users[0].measured);
    home_.write("materials/tile.csv", measurement("0.300"));
    const Library anew = read_paint_library(more);
    EXPECT_NE(anew->find("my tile")->measured->id, after->users[0].measured->id);
    EXPECT_EQ(read_whole_paint_library()->find("my tile")->measured->id,
              anew->find("my tile")->measured->id);
}

TEST_F(UsersLibrary, NamesAMeasuredFileThatIsBadAndReadsItAgainWhenItIsMended) {
    std::filesystem::create_directories(user_materials_folder());
    const auto tile = home_.write("materials/tile.csv", "nothing");
    home_.write("materials/tile.json", measured_paint_text("my tile", "tile.csv"));
    save_to_library(paint("mine"));
    const Library bad = read_whole_paint_library();
    EXPECT_EQ(bad->users.size(), 1u) << "the others are there";
    EXPECT_TRUE(bad->unread.empty());
    ASSERT_EQ(bad->problems.size(), 1u);
    EXPECT_NE(bad->problems[0].find(tile.string()), std::string::npos) << bad->problems[0];
    EXPECT_EQ(read_paint_library(bad), bad);
    home_.write("materials/tile.csv", measurement("0.2"));
    const Library mended = read_paint_library(bad);
    EXPECT_TRUE(mended->problems.empty());
    EXPECT_EQ(mended->users.size(), 2u);
}

TEST_F(UsersLibrary, HasFilesElsewhereOnceTheyAreAskedFor) {
    const TemporaryFolder elsewhere;
    write_material_file(elsewhere / "theirs.json", paint("theirs"));
    const auto file = (elsewhere / "theirs.json").string();
    const auto tile = elsewhere.write("tile.csv", measurement("0.2"));
    const Library before = read_paint_library();
    EXPECT_FALSE(is_read(look_up(*before, file).material));
    EXPECT_FALSE(is_read(look_up(*before, tile.string()).material));
    EXPECT_TRUE(look_up(*before, file).problem.empty()) << "nobody looked";
    EXPECT_EQ(look_up(*before, file).material.measured->file, file);

    const Library after = read_paint_library(before, {file, tile, elsewhere / "none.json"});
    EXPECT_EQ(look_up(*after, file).material.name, "theirs");
    EXPECT_TRUE(is_read(look_up(*after, tile.string()).material));
    EXPECT_EQ(look_up(*after, tile.string()).material.name, "tile");
    const NamedPaint none = look_up(*after, (elsewhere / "none.json").string());
    EXPECT_NE(none.problem.find("none.json: found no such file"), std::string::npos)
        << none.problem;
    EXPECT_EQ(none.material.diffuse, glm::dvec3(0.0));
    EXPECT_NE(look_up(*after, "solid rad").problem.find("nearest: 'solid red'"), std::string::npos);
    EXPECT_EQ(read_paint_library(after, {file, tile, elsewhere / "none.json"}), after);

    std::filesystem::remove(file);
    write_material_file(elsewhere / "none.json", paint("some"));
    const Library later = read_paint_library(after);
    EXPECT_FALSE(look_up(*later, file).problem.empty());
    EXPECT_EQ(look_up(*later, (elsewhere / "none.json").string()).material.name, "some");
    EXPECT_EQ(later->measured, after->measured);
}

TEST_F(UsersLibrary, NeverShadowsAShippedPaint) {
    std::filesystem::create_directories(user_materials_folder());
    write_material_file(user_materials_folder() / "a.json", paint("Solid_Red"));
    const PaintLibrary library = *read_paint_library();
    EXPECT_TRUE(library.users.empty());
    ASSERT_EQ(library.problems.size(), 1u);
    EXPECT_NE(library.problems[0].find("'Solid_Red'"), std::string::npos);
    EXPECT_NE(library.problems[0].find("change it in one of the files"), std::string::npos);
    EXPECT_NE(find_material("solid red").diffuse, glm::dvec3(0.1, 0.2, 0.3));
}

TEST_F(UsersLibrary, SaysWhereItCannotWrite) {
    home_.write("materials", "a file where the folder should be");
    EXPECT_TRUE(fails_with([] { save_to_library(paint("mine")); }, {"materials", "a folder"}));
}

TEST_F(UsersLibrary, IsNoneWithoutAHome) {
    unsetenv("LIVERY_HOME");
    const char* home = std::getenv("HOME");
    const std::string kept = home ? home : "";
    const char* data = std::getenv("XDG_DATA_HOME");
    const std::string kept_data = data ? data : "";
    unsetenv("HOME");
    unsetenv("XDG_DATA_HOME");
    EXPECT_GE(read_paint_library()->shipped.size(), 12u);
    EXPECT_TRUE(fails_with([] { save_to_library(paint("mine")); }, {"HOME"}));
    if (home) setenv("HOME", kept.c_str(), 1);
    if (data) setenv("XDG_DATA_HOME", kept_data.c_str(), 1);
}

}  // namespace
}  // namespace livery
