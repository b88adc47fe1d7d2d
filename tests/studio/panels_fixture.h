// Panels drawn without a window, with a pointer and keys of the test's own.
#pragma once

#include <cfloat>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <imgui.h>

#include "scene/library.h"
#include "studio/kit/imgui_versions.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"
#include "studio/presenting/ballot_panel.h"
#include "studio/studio.h"
#include "support/temporary_folder.h"

namespace livery {

using DrawPanel = void (*)(Studio&);

inline DrawPanel draw_of(const char* panel) { return panel_named(panel).draw; }

inline constexpr float kColumn = 320.0f;

inline Document two_looks() {
    Document document;
    document.library = read_paint_library();
    document.product = "sphere";
    for (const char* paint : {"solid red", "blue metallic"}) {
        SessionLook look;
        look.id = document.next_look_id++;
        look.look.name = std::string("look of ") + paint;
        look.look.parts["*"] = paint;
        look.look.lights.resize(2);
        look.look.lights[1].direction = {1.0, 0.0, 0.0};
        look.look.lights[1].radiance_rec709 = glm::dvec3(0.25);
        document.looks.push_back(look);
    }
    document.eye_mm = {0.0, 200.0, 600.0};
    return document;
}

inline void draw_ballot(Studio& studio) {
    show_ballots(studio, true);
    draw_ballot_panel(studio);
}

/// A studio without threads, projector and window, and an ImGui that draws nowhere.
class Panels : public ::testing::TestWithParam<float> {
  protected:
    Panels() {
        setenv("LIVERY_HOME", home_.path().c_str(), 1);
        ImGui::CreateContext();
        begin_keys();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = {2000.0f, 4000.0f};
        ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    }
    ~Panels() override { ImGui::DestroyContext(); }

    Studio make_studio() {
        Studio studio{Session::unsaved(two_looks(), "a test")};
        studio.product = find_product("sphere");
        studio.shown_look = studio.session.document().looks.front().id;
        studio.selected_part = 0;
        return studio;
    }

    void use_scale(float scale) {
        scale_ = scale;
        apply_theme(scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }

    /// One frame of the window; what the panel named.
    ItemPlaces frame(Studio& studio, DrawPanel draw) {
        ImGui::GetIO().DeltaTime = 0.1f;
        studio.now_s += 0.1;
        start_naming_items(true);
        ImGui::NewFrame();
        begin_trials(studio);
        ImGui::SetNextWindowPos({0.0f, 0.0f});
        ImGui::SetNextWindowSize({kColumn * scale_, 4000.0f});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
        draw(studio);
        ImGui::End();
        end_trials(studio);
        ImGui::Render();
        return take_named_items();
    }
    ItemPlaces frames(Studio& studio, DrawPanel draw, int count) {
        ItemPlaces places;
        for (int i = 0; i < count; ++i) places = frame(studio, draw);
        return places;
    }
    void point_at(const ItemPlaces& places, const std::string& name) {
        const auto found = places.find(name);
        ASSERT_NE(found, places.end()) << name;
        ImGui::GetIO().MousePos = {
            static_cast<float>(found->second.x) + 0.5f * static_cast<float>(found->second.width),
            static_cast<float>(found->second.y) + 0.5f * static_cast<float>(found->second.height)};
    }
    /// As a person does: the pointer comes from somewhere else.
    void move_to(Studio& studio, DrawPanel draw, const std::string& name) {
        const ItemPlaces places = frames(studio, draw, 2);
        ImGui::GetIO().MousePos = {1.0f, 3990.0f};
        frame(studio, draw);
        point_at(places, name);
        frames(studio, draw, 2);
    }
    void move_away(Studio& studio, DrawPanel draw) {
        ImGui::GetIO().MousePos = {-FLT_MAX, -FLT_MAX};
        frames(studio, draw, 2);
    }
    void click(Studio& studio, DrawPanel draw, const std::string& name) {
        point_at(frames(studio, draw, 2), name);
        frames(studio, draw, 2);
        ImGui::GetIO().MouseDown[0] = true;
        frame(studio, draw);
        ImGui::GetIO().MouseDown[0] = false;
        frames(studio, draw, 2);
    }
    void press(Studio& studio, DrawPanel draw, ImGuiKey key) {
        hold_key(key, true);
        frame(studio, draw);
        hold_key(key, false);
        frame(studio, draw);
    }

    float scale_ = 1.0f;
    TemporaryFolder home_;
};

}  // namespace livery
