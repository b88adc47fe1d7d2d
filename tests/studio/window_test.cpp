// Where the window stands, what its map says, and what its dialogs list.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/json.h"
#include "studio/kit/file_dialog.h"
#include "studio/kit/ui_map.h"
#include "studio/looks/look_files.h"
#include "studio/trace.h"
#include "studio/window/window_place.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

std::vector<Monitor> two_monitors() {
    return {
        {.id = "A", .name = "desk", .number = 1, .width = 1920, .height = 1080, .primary = true},
        {.id = "B", .name = "beamer", .number = 2, .x = 1920, .width = 1280, .height = 800}};
}

TEST(WindowPlace, SurvivesAsText) {
    const WindowPlace place{{-30, 40}, {1300, 820}, true};
    EXPECT_EQ(parse_window_place(text_of(place)), place);
    for (const char* bad : {"", "nonsense", "10x10+0+0", "1280x800", "1280x800+1"}) {
        EXPECT_FALSE(parse_window_place(bad)) << bad;
    }
}

TEST(WindowPlace, NeverOnTheProjector) {
    const WindowPlace on_b{{2000, 100}, {1280, 800}, false};
    const auto place = place_beside_projector(on_b, two_monitors(), "B");
    ASSERT_TRUE(place);
    EXPECT_EQ(place->position, glm::ivec2(640, 100));
    EXPECT_EQ(place_beside_projector(on_b, two_monitors(), "")->position, glm::ivec2(1920, 0))
        << "without a projector it stays on its monitor";
    const std::vector<Monitor> only = {two_monitors()[1]};
    EXPECT_FALSE(place_beside_projector(on_b, only, "B")) << "there is no other monitor";
}

TEST(WindowPlace, MovesOnlyWhenItMust) {
    const WindowPlace reaching_out{{-200, 900}, {1280, 800}, false};
    EXPECT_FALSE(must_move(reaching_out, two_monitors(), "B"));
    const WindowPlace reaching_over{{700, 100}, {1280, 800}, false};
    EXPECT_TRUE(must_move(reaching_over, two_monitors(), "B"));
    EXPECT_FALSE(must_move(reaching_over, two_monitors(), ""));
    const WindowPlace nowhere{{9000, 100}, {1280, 800}, false};
    EXPECT_TRUE(must_move(nowhere, two_monitors(), ""));
}

TEST(WindowPlace, ShrinksToItsMonitor) {
    const WindowPlace large{{0, 0}, {3000, 2000}, false};
    EXPECT_EQ(place_beside_projector(large, two_monitors(), "B")->size_px, glm::ivec2(1920, 1080));
}

TEST(Scale, FineScreensThatSayNothingGetTwo) {
    EXPECT_DOUBLE_EQ(default_scale(1.0f, {1280, 800}), 1.0);
    EXPECT_DOUBLE_EQ(default_scale(1.0f, {3840, 2160}), 2.0);
    EXPECT_DOUBLE_EQ(default_scale(1.5f, {3840, 2160}), 1.5);
}

TEST(UiMap, SaysPlacesAndState) {
    const Json json = Json::parse(ui_map_text(
        {{"paint:solid red", {10, 20, 30, 40}}}, {{"black", "true"}}, {1, 2, 1280, 800}));
    EXPECT_EQ(json["items"]["paint:solid red"], Json::array({10, 20, 30, 40}));
    EXPECT_EQ(json["state"]["black"], true);
    EXPECT_EQ(json["window"], Json::array({1, 2, 1280, 800}));
}

TEST(UiMap, IsWrittenWholeOrRefusedByName) {
    const TemporaryFolder folder;
    UiMapFile map(folder.path() / "map.json");
    map.update({}, {{"black", "false"}}, {});
    EXPECT_FALSE(read_json_file(folder.path() / "map.json")["state"]["black"]);
    map.update({}, {{"black", "true"}}, {});
    EXPECT_TRUE(read_json_file(folder.path() / "map.json")["state"]["black"]);
    UiMapFile nowhere(folder.path() / "missing" / "map.json");
    EXPECT_THROW(nowhere.update({}, {}, {}), FileError);
}

TEST(Trace, WritesALineAnEvent) {
    const TemporaryFolder folder;
    Trace trace(folder.path() / "trace");
    trace.write("frame-asked", 7, "with \"quotes\"");
    std::ifstream file(folder.path() / "trace");
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    const Json json = Json::parse(line);
    EXPECT_EQ(json["event"], "frame-asked");
    EXPECT_EQ(json["number"], 7);
    EXPECT_EQ(json["what"], "with \"quotes\"");
    EXPECT_THROW(Trace(folder.path() / "missing" / "trace"), FileError);
}

TEST(FileDialog, ListsFoldersFirstAndOnlyWhatFits) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "Zoo");
    std::filesystem::create_directory(folder.path() / ".hidden");
    for (const char* name : {"b.json", "A.JSON", "c.txt"}) std::ofstream(folder.path() / name);
    const auto names = [&](const std::vector<std::string>& suffixes, bool folders_only) {
        std::string all;
        for (const auto& entry : list_folder(folder.path(), suffixes, folders_only)) {
            all += entry.name + (entry.is_folder ? "/ " : " ");
        }
        return all;
    };
    EXPECT_EQ(names({".json"}, false), "Zoo/ A.JSON b.json ");
    EXPECT_EQ(names({}, false), "Zoo/ A.JSON b.json c.txt ");
    EXPECT_EQ(names({}, true), "Zoo/ ");
    EXPECT_TRUE(list_folder(folder.path() / "missing", {}, false).empty());
}

TEST(FileNames, AreMadeOfNames) {
    EXPECT_EQ(file_name_of("Blue metallic / 2"), "Blue-metallic-2");
    EXPECT_EQ(file_name_of("grün"), "grün");
    EXPECT_EQ(file_name_of("//"), "look");
}

}  // namespace
}  // namespace livery
