// The program on GNOME's Wayland desktop: who the projector is and what the desktop does to its
// picture, which X does not tell there.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "desktop/prepared.h"
#include "support/wayland_desktop.h"

namespace livery {
namespace {

using nlohmann::json;

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// What `livery capture --list --json` says of monitors, in another process on that desktop.
json listed_monitors(const WaylandDesktop& desktop) {
    const TemporaryFolder folder;
    ChildOptions options;
    // Its JSON alone: what it says besides goes elsewhere.
    options.arguments = {
        "sh", "-c", "exec \"$0\" capture --list --json 2>/dev/null", LIVERY_PROGRAM};
    options.environment = desktop.environment();
    options.output = folder / "listed.json";
    ChildProcess list(options);
    EXPECT_EQ(list.wait(patience), 0) << text_of(options.output);
    return json::parse(text_of(options.output))["monitors"];
}

TEST(WaylandProjector, NightlyIsFoundByNameAndItsScaleIsTold) {
    if (const std::string missing = WaylandDesktop::what_is_missing(); !missing.empty()) {
        GTEST_SKIP() << missing;
    }
    const TemporaryFolder folder;
    prepare_session(folder / "session.livery");
    // Half as large again is just what Mutter still allows.
    WaylandDesktop desktop({1280, 800}, {1200, 720});
    const json listed = listed_monitors(desktop);
    ASSERT_EQ(listed.size(), 2u);
    const json& projector = listed[1];
    EXPECT_EQ(projector["name"], "Meta-1, MetaVirtualMonitor");
    EXPECT_EQ(projector["maker"], "MetaVendor");
    EXPECT_EQ(projector["serial"], "0x01");
    EXPECT_EQ(projector["mode"], json({1200, 720}));
    EXPECT_EQ(projector["scale"], 1.0);
    const std::string id = projector["id"];
    EXPECT_TRUE(id.starts_with("Meta-1:")) << id;

    // As a start before this one has left it.
    const json settings = {{"format_version", 1},
                           {"settings", {{"projector-monitor", id}, {"refine-while-still", "no"}}}};
    std::filesystem::create_directory(folder / "home");
    folder.write("home/desktop.json", settings.dump());
    ChildOptions options;
    options.arguments = {LIVERY_PROGRAM,
                         "desktop",
                         "--session",
                         (folder / "session.livery").string(),
                         "--ui-map",
                         (folder / "map").string(),
                         "--ui-scale",
                         "1"};
    options.environment = desktop.environment();
    options.environment["LIVERY_HOME"] = (folder / "home").string();
    options.output = folder / "output";
    ChildProcess program(options);
    const auto state = [&](const char* name) {
        return json::parse(text_of(folder / "map"))["state"][name];
    };
    const auto words = [&] {
        return tail_of(folder / "output") + tail_of(folder / "home/log/livery.log") +
               (std::filesystem::exists(folder / "map") ? state("signal_says").dump() : "no map");
    };
    ASSERT_TRUE(wait_until([&] {
        return !program.running() ||
               (std::filesystem::exists(folder / "map") && state("projector") == "showing");
    })) << words();
    ASSERT_TRUE(program.running()) << words();
    EXPECT_EQ(state("projector_monitor"), id);

    const auto is_told = [&](const std::string& text) {
        return state("signal_says").dump().find(text) != std::string::npos;
    };
    const std::string scaled =
        "Meta-1 shows 800x480 of the desktop with 1200x720 pixels, at "
        "GNOME's scale of 150%.";
    EXPECT_TRUE(wait_until([&] {
        return is_told("no program can read or set the graphics card's");
    })) << words();
    EXPECT_FALSE(is_told("scale of 150%"));
    desktop.set_projector(1.5);
    EXPECT_TRUE(wait_until([&] { return is_told(scaled); })) << words();
    EXPECT_TRUE(is_told("set Scale to 100%")) << words();
    EXPECT_TRUE(wait_until([&] { return state("signal_severity") == "error"; })) << words();
    EXPECT_TRUE(wait_until([&] { return state("projector") == "showing"; })) << words();
    EXPECT_EQ(state("projector_monitor"), id);
    const json scaled_list = listed_monitors(desktop)[1];
    EXPECT_EQ(scaled_list["id"], id);
    EXPECT_EQ(scaled_list["scale"], 1.5);
    EXPECT_EQ(scaled_list["width"], 800);
    EXPECT_EQ(scaled_list["mode"], json({1200, 720}));
    EXPECT_EQ(scaled_list["signal"][0]["severity"], "error");

    desktop.set_projector(1.0, 2);
    EXPECT_TRUE(wait_until([&] { return is_told("GNOME turns by 180° what Meta-1 shows."); }))
        << words();
    EXPECT_FALSE(is_told(scaled));
    desktop.set_projector(1.0);
    EXPECT_TRUE(wait_until([&] { return state("signal_severity") != "error"; })) << words();
    EXPECT_FALSE(is_told("scale of")) << words();
    EXPECT_TRUE(wait_until([&] { return state("projector") == "showing"; })) << words();
    EXPECT_TRUE(program.running()) << words();
}

}  // namespace
}  // namespace livery
