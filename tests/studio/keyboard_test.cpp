// File dialogs and panels by keyboard and pointer, drawn without a window.
#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include "core/paths.h"
#include "scene/library.h"
#include "studio/kit/file_dialog.h"
#include "studio/kit/imgui_versions.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/user_settings.h"
#include "studio/kit/widgets.h"
#include "studio/projector.h"
#include "studio/studio.h"
#include "studio/window/layout.h"
#include "support/temporary_folder.h"

namespace livery {
namespace {

namespace fs = std::filesystem;

/// An ImGui that draws nowhere, and folders of the test's own as home and as the user's folder.
class Keyboard : public ::testing::Test {
  protected:
    Keyboard() {
        // Of the test's own process; every test of this file sets them anew.
        setenv("LIVERY_HOME", (home_.path() / "livery").c_str(), 1);
        setenv("HOME", home_.path().c_str(), 1);
        ImGui::CreateContext();
        begin_keys();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280.0f, 800.0f};
        io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
        io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
        apply_theme(1.0f);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        settings_ = read_user_settings();
        dialog_ = std::make_unique<FileDialog>(settings_);
        fs::create_directories(home_ / "cars/old");
        for (const char* name : {"cars/a.json", "cars/b.json", "cars/notes.txt", "top.json"}) {
            std::ofstream(home_ / name) << "{}";
        }
    }
    ~Keyboard() override {
        dialog_.reset();
        ImGui::DestroyContext();
    }

    ItemPlaces frame(int tab_step = 0) {
        ImGui::GetIO().DeltaTime = 0.1f;
        start_naming_items(true);
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0.0f, 0.0f});
        ImGui::SetNextWindowSize({420.0f, 800.0f});
        ImGui::Begin("Livery", nullptr, ImGuiWindowFlags_NoDecoration);
        if (draw_) draw_();
        ImGui::End();
        dialog_->draw();
        if (tab_step != 0) move_focus(tab_step);
        focused_now_ = focused_item();
        ImGui::Render();
        return take_named_items();
    }
    ItemPlaces frames(int count) {
        ItemPlaces places;
        for (int i = 0; i < count; ++i) places = frame();
        return places;
    }
    /// The item's name after a press of Tab.
    std::string tab(int step = 1) {
        frame(step);
        frames(2);
        return focused_now_;
    }
    void press(ImGuiKey key) {
        hold_key(key, true);
        frame();
        hold_key(key, false);
        frames(2);
    }
    void type(const std::string& text) {
        for (const char c : text) ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(c));
        frames(2);
    }
    void click(const std::string& name, int times = 1) {
        const ItemPlaces places = frames(2);
        const auto found = places.find(name);
        ASSERT_NE(found, places.end()) << name;
        const auto& [x, y, width, height] = found->second;
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {static_cast<float>(x) + 0.5f * static_cast<float>(width),
                       static_cast<float>(y) + 0.5f * static_cast<float>(height)};
        frames(8);  // not the second click of the one before
        for (int k = 0; k < times; ++k) {
            io.MouseDown[0] = true;
            frame();
            io.MouseDown[0] = false;
            frame();
        }
        io.MousePos = {-1.0f, -1.0f};
        frames(2);
    }

    FileQuestion question(FileQuestion::Kind kind, const std::string& suggested = "") {
        FileQuestion asked;
        asked.kind = kind;
        asked.title = "A test";
        asked.action = "Do";
        asked.suffixes = {".json"};
        asked.suggested = suggested;
        asked.then = [this](const fs::path& file) { answers_.push_back(file); };
        return asked;
    }
    void ask(const FileQuestion& asked) {
        dialog_->ask(asked);
        frames(4);
    }

    TemporaryFolder home_;
    UserSettings settings_;
    std::unique_ptr<FileDialog> dialog_;
    std::function<void()> draw_;
    std::string focused_now_;
    std::vector<fs::path> answers_;
};

TEST_F(Keyboard, ANewSessionHasTheProjectorOfTheOneBefore) {
    const auto new_session = [] {
        auto studio = std::make_unique<Studio>(Session::unsaved(Document{}, "a test"));
        studio->settings = read_user_settings();
        restore_workspace(*studio);
        return studio;
    };
    EXPECT_EQ(new_session()->projector_monitor, "");
    const auto first = new_session();
    use_projector_monitor(*first, "HDMI-1");
    EXPECT_EQ(new_session()->projector_monitor, "HDMI-1");
    // A session that has chosen keeps its choice.
    first->session.set_workspace("projector-monitor", "");
    restore_workspace(*first);
    EXPECT_EQ(first->projector_monitor, "");
}

TEST_F(Keyboard, ADialogStartsAtHomeThenWhereTheUserLastWas) {
    ask(question(FileQuestion::Kind::open));
    EXPECT_TRUE(frame().contains("file-dialog:top.json"));
    click("file-dialog:cars", 2);
    click("file-dialog:a.json", 2);
    ASSERT_EQ(answers_, std::vector<fs::path>{home_ / "cars/a.json"});
    EXPECT_FALSE(dialog_->is_open());
    ask(question(FileQuestion::Kind::open));
    EXPECT_TRUE(frame().contains("file-dialog:b.json"));
    EXPECT_FALSE(frame().contains("file-dialog:notes.txt"));
    press(ImGuiKey_Escape);
    // After a restart as well, and for another question.
    settings_ = read_user_settings();
    FileQuestion other = question(FileQuestion::Kind::open, home_.path().string());
    other.title = "Another";
    ask(other);
    EXPECT_TRUE(frame().contains("file-dialog:b.json"));
    // A folder that is gone is as if nobody had been there.
    press(ImGuiKey_Escape);
    fs::remove_all(home_ / "cars");
    ask(question(FileQuestion::Kind::open));
    EXPECT_TRUE(frame().contains("file-dialog:top.json"));
}

TEST_F(Keyboard, AFieldWhoseTextChangedMeanwhileUndoesNothing) {
    std::string text;
    draw_ = [&] {
        ImGui::InputText("##field", &text);
        name_last_item("field");
    };
    const auto with_ctrl = [&](ImGuiKey key) {
        hold_ctrl(true);
        press(key);
        hold_ctrl(false);
        frames(2);
    };
    click("field");
    for (const char letter : std::string("long")) type({letter});
    with_ctrl(ImGuiKey_Z);
    EXPECT_EQ(text, "lon");
    with_ctrl(ImGuiKey_Y);
    EXPECT_EQ(text, "long");
    ImGui::ClearActiveID();
    frames(2);
    // The same field of another dialog, another look or another paint.
    text.clear();
    click("field");
    with_ctrl(ImGuiKey_Z);
    with_ctrl(ImGuiKey_Y);
    EXPECT_EQ(text, "");
}

TEST_F(Keyboard, AFieldIsTypedInAlsoWhenAnotherItemHasTheKeyboard) {
    std::string text;
    bool asked = false;
    draw_ = [&] {
        ImGui::Button("above");
        name_last_item("above");
        ImGui::BeginChild("below", {300.0f, 200.0f});
        if (std::exchange(asked, false)) focus_next_field("##field");
        ImGui::InputText("##field", &text);
        name_last_item("field");
        ImGui::EndChild();
    };
    frames(2);
    while (tab() != "above") {
    }
    asked = true;
    frames(3);
    EXPECT_EQ(focused_now_, "field");
    type("red");
    EXPECT_EQ(text, "red");
    // The field itself loses the keyboard and is asked for again.
    press(ImGuiKey_Escape);
    asked = true;
    frames(3);
    type("blue");
    EXPECT_EQ(text, "blue");
}

TEST_F(Keyboard, ATypedFolderIsEnteredAndATypedNameLiesInTheShownOne) {
    ask(question(FileQuestion::Kind::save, "suggested.json"));
    click("file-dialog:cars", 2);
    EXPECT_TRUE(answers_.empty());
    press(ImGuiKey_Escape);
    ask(question(FileQuestion::Kind::save));
    type("cars/");
    press(ImGuiKey_Enter);
    EXPECT_TRUE(answers_.empty());
    EXPECT_TRUE(frame().contains("file-dialog:b.json")) << "entered";
    type("mine");
    press(ImGuiKey_Enter);
    EXPECT_EQ(answers_, std::vector<fs::path>{home_ / "cars/mine.json"});
    answers_.clear();

    // It stays while one goes elsewhere.
    ask(question(FileQuestion::Kind::save));
    type("mine.json");
    click("file-dialog:up");
    click("file-dialog:ok");
    EXPECT_EQ(answers_, std::vector<fs::path>{home_ / "mine.json"});
    answers_.clear();
    ask(question(FileQuestion::Kind::save));
    type("~/cars/old/x.json");
    press(ImGuiKey_Enter);
    EXPECT_EQ(answers_, std::vector<fs::path>{home_ / "cars/old/x.json"});
}

TEST_F(Keyboard, OneClickOnAFolderOnlyChoosesIt) {
    ask(question(FileQuestion::Kind::open));
    click("file-dialog:cars");
    EXPECT_TRUE(frame().contains("file-dialog:top.json"));
    click("file-dialog:ok");
    EXPECT_TRUE(frame().contains("file-dialog:b.json")) << "entered by the button";
    press(ImGuiKey_Escape);
    ask(question(FileQuestion::Kind::folder));
    click("file-dialog:cars");
    click("file-dialog:ok");
    EXPECT_EQ(answers_, std::vector<fs::path>{home_ / "cars"});
}

TEST_F(Keyboard, AskBeforeAFileIsReplacedAndSayWhatIsWrong) {
    ask(question(FileQuestion::Kind::save, "top.json"));
    press(ImGuiKey_Enter);
    EXPECT_TRUE(dialog_->is_open()) << "there is such a file";
    press(ImGuiKey_Enter);
    frames(2);
    click("file-dialog:ok");
    EXPECT_EQ(answers_.size(), 1u);
    answers_.clear();
    ask(question(FileQuestion::Kind::open));
    type("nowhere.json");
    press(ImGuiKey_Enter);
    EXPECT_TRUE(dialog_->is_open());
    EXPECT_TRUE(answers_.empty());
}

TEST_F(Keyboard, ChoicesChangeTheEndingAndKeepATypedName) {
    FileQuestion asked = question(FileQuestion::Kind::save, "car-preview.json");
    std::string suffix = ".json";
    asked.choices = [&](FileQuestion& changed) {
        changed.suffixes = {suffix};
        changed.suggested = "car-preview" + suffix;
    };
    ask(asked);
    suffix = ".txt";
    frames(2);
    click("file-dialog:ok");
    EXPECT_EQ(answers_, std::vector<fs::path>{home_ / "car-preview.txt"});
}

TEST_F(Keyboard, TabReachesEverythingInADialog) {
    ask(question(FileQuestion::Kind::open));
    std::set<std::string> reached;
    for (int k = 0; k < 12; ++k) reached.insert(tab());
    for (const char* name : {"file-dialog:home",
                             "file-dialog:cars",
                             "file-dialog:top.json",
                             "file-dialog:path",
                             "file-dialog:cancel",
                             "file-dialog:ok"}) {
        EXPECT_TRUE(reached.contains(name)) << name;
    }
    while (tab() != "file-dialog:cars") {
    }
    press(ImGuiKey_Enter);
    EXPECT_TRUE(frame().contains("file-dialog:b.json"));
}

/// A panel's studio, without threads, projector and window.
Studio sphere_studio() {
    Document document;
    document.library = read_paint_library();
    document.product = "sphere";
    SessionLook look;
    look.id = document.next_look_id++;
    look.look.name = "red";
    look.look.parts["*"] = "solid red";
    look.look.lights.resize(2);
    document.looks.push_back(look);
    document.eye_mm = {0.0, 200.0, 600.0};
    Studio studio{Session::unsaved(document, "a test")};
    studio.product = find_product("sphere");
    studio.shown_look = document.looks.front().id;
    studio.selected_part = 0;
    return studio;
}

TEST_F(Keyboard, TabGoesThroughEveryPanelAndBack) {
    Studio studio = sphere_studio();
    using DrawPanel = void (*)(Studio&);
    const std::vector<std::pair<DrawPanel, std::vector<std::string>>> panels{
        {draw_of("Paints"), {"paint-search", "family:all", "paint:solid red"}},
        {draw_of("Paint"), {"paint-colour", "param:model", "param:diffuse:hex", "save-paint"}},
        {draw_of("Artwork"), {"artwork:add"}},
        {draw_of("Light"), {"light:0:intensity", "add-light", "exposure", "quality:high"}},
        {draw_of("Calibrate"), {"bench", "design-white", "keep-hue", "calibration:none"}},
        {draw_of("looks"), {"look:1", "duplicate-look-button"}},
        {draw_of("parts"), {"part:sphere"}}};
    for (const auto& [draw, expected] : panels) {
        draw_ = [&studio, panel = draw] {
            begin_trials(studio);
            panel(studio);
            end_trials(studio);
        };
        frames(3);
        const std::string first = tab();
        std::vector<std::string> order{first};
        for (std::string next = tab(); next != first && order.size() < 200; next = tab()) {
            order.push_back(next);
        }
        // Every light's colour goes by the same names.
        std::erase_if(order, [](const auto& name) { return name.starts_with("light-colour"); });
        const std::set<std::string> reached(order.begin(), order.end());
        EXPECT_EQ(reached.size(), order.size())
            << "each once, not " << fmt::format("{}", fmt::join(order, ", "));
        for (const std::string& name : expected) {
            EXPECT_TRUE(reached.contains(name)) << name << " is not among them";
        }
        EXPECT_EQ(tab(-1), order.back());
    }
    EXPECT_EQ(studio.session.revision(), sphere_studio().session.revision());
    EXPECT_FALSE(studio.tried) << "going somewhere tries nothing";
}

}  // namespace
}  // namespace livery
