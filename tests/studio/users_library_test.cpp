// A measured paint of the user's comes into the library without the window waiting for its file.
#include "studio/paint/users_library.h"

#include <condition_variable>
#include <cstdlib>
#include <fstream>
#include <mutex>

#include <gtest/gtest.h>

#include "appearance/merl_bytes.h"
#include "session/document.h"
#include "studio/kit/background.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

class UsersLibrary : public testing::Test {
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
    const PaintLibrary& library = current_library(studio_);
    EXPECT_FALSE(library.shipped.empty());
    EXPECT_TRUE(library.users.empty()) << "the window waited for the file";
    EXPECT_TRUE(library.problems.empty());
    EXPECT_EQ(library.unread.size(), 1u);
    EXPECT_EQ(studio_.panels.library.being_read.size(), 1u);

    wait_for_background();
    ASSERT_EQ(library.users.size(), 1u);
    EXPECT_EQ(library.users[0].name, "my tile");
    EXPECT_TRUE(library.unread.empty());
    EXPECT_TRUE(studio_.panels.library.being_read.empty());
    // Now in memory: whoever must not wait gets it.
    const OnlyMeasuredInMemory no_waiting;
    EXPECT_EQ(find_material("My-Tile").measured, library.users[0].measured);
}

TEST_F(UsersLibrary, AFileThatCannotBeReadIsAProblemAndIsReadOnce) {
    write_paint("cut off", grey_tile().substr(0, 1000));
    const PaintLibrary& library = current_library(studio_);
    EXPECT_TRUE(library.problems.empty());
    wait_for_background();
    EXPECT_TRUE(library.users.empty());
    ASSERT_EQ(library.problems.size(), 1u);
    EXPECT_NE(library.problems[0].find("cut off.binary"), std::string::npos) << library.problems[0];
    EXPECT_TRUE(studio_.panels.library.being_read.empty());
    EXPECT_FALSE(studio_.background->is_busy());
}

TEST_F(UsersLibrary, WhatIsStillBeingReadIsSaidInsteadOfWaitedFor) {
    write_paint("my tile", grey_tile());
    const OnlyMeasuredInMemory no_waiting;
    try {
        find_material("my tile");
        FAIL() << "it was found";
    } catch (const MeasuredFileUnread& unread) {
        EXPECT_EQ(unread.file(), home_ / "materials/my tile.binary");
        EXPECT_NE(std::string(unread.what()).find("still being read"), std::string::npos);
    }
    EXPECT_EQ(find_material("solid red").name, "solid red");
}

}  // namespace
}  // namespace livery
