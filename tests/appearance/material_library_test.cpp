// The user's own paints beside the shipped ones: found by name, never shadowing, never replaced.
#include "appearance/material_library.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/paths.h"
#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

/// Each test has a home of its own.
class UsersLibrary : public testing::Test {
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
    const PaintLibrary library = read_paint_library();
    EXPECT_GE(library.shipped.size(), 12u);
    EXPECT_TRUE(library.users.empty());
    EXPECT_TRUE(library.problems.empty());
    EXPECT_FALSE(std::filesystem::exists(user_materials_folder()));
}

TEST_F(UsersLibrary, FindsWhatWasSaved) {
    const auto file = save_to_library(paint("Müller's Blue"));
    EXPECT_EQ(file.parent_path(), home_.path() / "materials");
    EXPECT_EQ(find_material("Müller's-blue").diffuse, glm::dvec3(0.1, 0.2, 0.3));
    const PaintLibrary library = read_paint_library();
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
    EXPECT_EQ(read_paint_library().users.size(), 1u);
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
    EXPECT_TRUE(read_paint_library().users.empty());
}

TEST_F(UsersLibrary, KeepsFilesThatItCannotRead) {
    std::filesystem::create_directories(user_materials_folder());
    const auto broken = home_.write("materials/mine.json", "{\"format_version\": 1");
    home_.write("materials/notes.txt", "no paint");
    const auto file = save_to_library(paint("mine"));
    EXPECT_EQ(file.filename(), "mine-2.json");
    EXPECT_EQ(read_text_file(broken), "{\"format_version\": 1");
    const PaintLibrary library = read_paint_library();
    ASSERT_EQ(library.users.size(), 1u);
    ASSERT_EQ(library.problems.size(), 1u);
    EXPECT_NE(library.problems[0].find(broken.string()), std::string::npos);
    // Whoever looks for the broken one is told of it; the others are found.
    EXPECT_TRUE(fails_with([] { find_material("hers"); }, {"'hers'", "left out", "mine.json"}));
    EXPECT_EQ(find_material("solid red").name, "solid red");
    EXPECT_EQ(find_material("mine").name, "mine");
}

TEST_F(UsersLibrary, NeverShadowsAShippedPaint) {
    std::filesystem::create_directories(user_materials_folder());
    write_material_file(user_materials_folder() / "a.json", paint("Solid_Red"));
    const PaintLibrary library = read_paint_library();
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
    EXPECT_GE(read_paint_library().shipped.size(), 12u);
    EXPECT_TRUE(fails_with([] { save_to_library(paint("mine")); }, {"HOME"}));
    if (home) setenv("HOME", kept.c_str(), 1);
    if (data) setenv("XDG_DATA_HOME", kept_data.c_str(), 1);
}

}  // namespace
}  // namespace livery
