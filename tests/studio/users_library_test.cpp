// A measured paint of the user's comes into the library without the window waiting for its file.
#include "studio/users_library.h"

#include <condition_variable>
#include <cstdlib>
#include <fstream>
#include <mutex>

#include <gtest/gtest.h>

#include "appearance/measured/measured_paint.h"
#include "appearance/merl_bytes.h"
#include "scene/library.h"
#include "studio/kit/background.h"
#include "studio/paint/library_panel.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

class UsersLibrary : public ::testing::Test {
  protected:
    UsersLibrary() {
        setenv("LIVERY_HOME", home_.path().c_str(), 1);
        std::filesystem::create_directories(home_ / "materials");
        studio_.background = std::make_unique<Background>([this] {
            const std::scoped_lock lock(mutex_);
            ++woken_;
            changed_.notify_all();
        });
    }

    void write_paint(const std::string& name, const std::string& measured_bytes) {
        std::ofstream(home_ / ("materials/" + name + ".binary"), std::ios::binary)
            << measured_bytes;
        std::ofstream(home_ / ("materials/" + name + ".json"))
            << R"({"format_version": 1, "name": ")" << name
            << R"(", "model": "measured", "parameters": {"file": ")" << name << R"(.binary"}})";
    }
    void wait_for_background() {
        std::unique_lock lock(mutex_);
        ASSERT_TRUE(changed_.wait_for(lock, std::chrono::minutes(5), [&] { return woken_ > 0; }));
        woken_ = 0;
        lock.unlock();
        studio_.background->take_results();
    }

    TemporaryFolder home_;
    std::mutex mutex_;
    std::condition_variable changed_;
    int woken_ = 0;
    Studio studio_{Session::unsaved(new_document("sphere"), "a test")};
};

std::string grey_tile() {
    return merl_bytes([](const glm::dvec3&, const glm::dvec3&) { return glm::dvec3(0.1); });
}

TEST_F(UsersLibrary, AMeasuredPaintIsThereOnceItsFileWasReadBehind) {
    write_paint("my tile", grey_tile());
    refresh_library(studio_);
    EXPECT_EQ(current_library(studio_).find("my tile"), nullptr) << "the window waited";
    wait_for_background();
    // In the first snapshot it is known, in the next it is read.
    EXPECT_FALSE(current_library(studio_).shipped.empty());
    EXPECT_TRUE(current_library(studio_).users.empty()) << "the window waited for the file";
    EXPECT_TRUE(current_library(studio_).problems.empty());
    EXPECT_EQ(current_library(studio_).unread.size(), 1u);
    EXPECT_EQ(studio_.panels.of<LibraryReadings>().now.files.size(), 1u);
    const std::uint64_t revision = studio_.session.revision();

    wait_for_background();
    ASSERT_EQ(current_library(studio_).users.size(), 1u);
    EXPECT_EQ(current_library(studio_).users[0].name, "my tile");
    EXPECT_TRUE(current_library(studio_).unread.empty());
    EXPECT_TRUE(studio_.panels.of<LibraryReadings>().now.files.empty());
    EXPECT_FALSE(studio_.background->is_busy());
    EXPECT_GT(studio_.session.revision(), revision) << "nobody draws it";
    const Material found = find_paint(studio_.session.document(), "My-Tile");
    EXPECT_EQ(found.measured, current_library(studio_).users[0].measured);
}

TEST_F(UsersLibrary, AFileThatCannotBeReadIsAProblemAndIsReadOnce) {
    write_paint("cut off", grey_tile().substr(0, 1000));
    refresh_library(studio_);
    wait_for_background();
    EXPECT_TRUE(current_library(studio_).problems.empty());
    wait_for_background();
    EXPECT_TRUE(current_library(studio_).users.empty());
    const auto problems = current_library(studio_).problems;
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_NE(problems[0].find("cut off.binary"), std::string::npos) << problems[0];
    EXPECT_FALSE(studio_.panels.of<LibraryReadings>().now.asked);
    EXPECT_FALSE(studio_.background->is_busy());
}

TEST_F(UsersLibrary, UndoToAPaintThatIsNotReadWaitsForNothing) {
    write_paint("my tile", grey_tile());
    const auto file = home_ / "materials/my tile.binary";
    Material paint = with_measured_read(read_paint_file(home_ / "materials/my tile.json"));
    studio_.session.execute(EditPaint{1, "*", paint});
    studio_.session.execute(PaintProduct{1, "solid red"});
    const std::string worn = "my tile";
    studio_.session.undo();
    const Document& document = studio_.session.document();
    EXPECT_FALSE(is_read(look_up(document, worn).material)) << "undo read the file";
    const Scene scene = scene_of(document, 1, find_product("sphere"));
    EXPECT_EQ(unread_files(scene), std::set{file});
    bool called = false;
    refresh_library(studio_, unread_files(scene), [&] { called = true; });
    refresh_library(studio_, unread_files(scene));
    wait_for_background();
    EXPECT_TRUE(called);
    EXPECT_FALSE(studio_.background->is_busy()) << "the file was asked for twice";
    EXPECT_EQ(look_up(document, worn).material.measured->id, paint.measured->id);
    EXPECT_TRUE(unread_files(scene_of(document, 1, find_product("sphere"))).empty());
}

TEST_F(UsersLibrary, APaintThatWasSavedMeanwhileStays) {
    refresh_library(studio_);
    Material paint;
    paint.name = "saved";
    save_to_library(paint);
    studio_.session.use(read_paint_library(studio_.session.document().library));
    write_paint("my tile", grey_tile());
    do wait_for_background();
    while (studio_.panels.of<LibraryReadings>().now.asked);
    EXPECT_NE(current_library(studio_).find("saved"), nullptr);
    EXPECT_TRUE(is_read(*current_library(studio_).find("my tile")));
}

}  // namespace
}  // namespace livery
