// Names that people type for products and looks.
#include "scene/library.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "support/file_error.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

namespace fs = std::filesystem;

TEST(Library, SaysWhichNamesThereAre) {
    EXPECT_TRUE(fails_with([] { find_product("teapot"); },
                           {"teapot", "no such file or shipped product", "car, player or sphere"}));
    EXPECT_TRUE(fails_with([] { find_look("chrome dream"); },
                           {"chrome dream", "no such file or shipped look", "blue-metallic"}));
    EXPECT_TRUE(fails_with([] { find_product("car", LengthUnit::m); }, {"car", "unit"}));
}

TEST(Library, KnowsThePartsOfTheProductThatWasReadLast) {
    const TemporaryFolder folder;
    const fs::path file = folder / "thing.obj";
    const auto write = [&](const std::string& part) {
        std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\no " << part << "\nf 1 2 3\n";
    };
    const std::string name = file.string();
    write("lid");
    find_product(name, LengthUnit::mm);
    write("bowl");
    // Not read again for each command of a session
    EXPECT_EQ(part_names(name), std::vector<std::string>{"lid"});
    find_product(name, LengthUnit::mm);
    EXPECT_EQ(part_names(name), std::vector<std::string>{"bowl"});
    fs::remove(file);
    EXPECT_EQ(part_names(name), std::vector<std::string>{"bowl"});
}

TEST(Library, AShippedLookLeavesOutWhatAProductLacks) {
    const std::string name = shipped_looks().front();
    const Look car = find_look_for(name, part_names("car"));
    EXPECT_TRUE(car.parts.contains("body"));
    EXPECT_FALSE(car.parts.contains("*"));
    // A player has no body: all of it wears the body's paint, and keeps what it shares.
    const Look player = find_look_for(name, part_names("player"));
    EXPECT_FALSE(player.parts.contains("body"));
    EXPECT_FALSE(player.parts.contains("tyres"));
    ASSERT_TRUE(player.parts.contains("*"));
    EXPECT_EQ(player.parts.at("*"), car.parts.at("body"));
    EXPECT_EQ(player.parts.at("glass"), car.parts.at("glass"));
}

}  // namespace
}  // namespace livery
