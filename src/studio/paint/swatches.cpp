#include "studio/paint/swatches.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include "appearance/parameter_table.h"
#include "studio/paint/library_panel.h"
#include "studio/paint/paint_rows.h"
#include "studio/users_library.h"

namespace livery {

namespace {

/// Enough for every paint that one sees at once, several times over.
constexpr std::size_t kMostKept = 300;

/// All that the picture depends on.
std::string key_of(const Material& m, int size_px) {
    return fmt::format("{} {}", size_px, fmt::join(reflectance_numbers(m), " "));
}

void draw_plain_disc(const Material& material, const ImVec2& corner, float side) {
    ImGui::GetWindowDrawList()->AddCircleFilled({corner.x + 0.5f * side, corner.y + 0.5f * side},
                                                0.46f * side,
                                                screen_colour(drawn_face_lab(material)),
                                                48);
}

}  // namespace

void SwatchInbox::put(const std::string& key, const Image8& picture) {
    {
        const std::scoped_lock lock(mutex_);
        drawn_[key] = picture;
    }
    wake_main_thread();
}

std::map<std::string, Image8> SwatchInbox::take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(drawn_, {});
}

void take_swatches(Studio& studio) {
    LibraryPanelState& state = studio.panels.of<LibraryPanelState>();
    const auto drawn = state.inbox->take();
    if (state.swatches.size() + drawn.size() > kMostKept) {
        state.swatches.clear();
        state.asked.clear();
    }
    for (const auto& [key, picture] : drawn) {
        state.asked.erase(key);
        if (picture.channels != 4 || picture.empty()) continue;
        state.swatches.insert_or_assign(key, texture_of(picture));
    }
}

void draw_swatch(Studio& studio, const Material& material, const ImVec2& corner, float side_px) {
    LibraryPanelState& state = studio.panels.of<LibraryPanelState>();
    // Few sizes, so that dragging a panel's edge does not draw all of them anew.
    const int size_px = std::clamp(static_cast<int>(std::ceil(side_px / 32.0f)) * 32, 64, 256);
    const std::string key = key_of(material, size_px);
    if (const auto found = state.swatches.find(key); found != state.swatches.end()) {
        ImGui::GetWindowDrawList()->AddImage(
            imgui_texture(found->second.name()), corner, {corner.x + side_px, corner.y + side_px});
        return;
    }
    draw_plain_disc(material, corner, side_px);
    if (!studio.previews || studio.opening || !state.asked.insert(key).second) return;
    studio.previews->request_swatch(
        material, size_px, [inbox = state.inbox, key](const Image8& rgba) {
            inbox->put(key, rgba);
        });
}

void draw_swatch_cell(Studio& studio,
                      const Material& paint,
                      const std::string& distance,
                      const ImVec2& corner,
                      float width,
                      bool worn,
                      bool lit) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float side = std::floor(0.78f * width);
    const float left = std::floor(corner.x + 0.5f * (width - side)), top = corner.y + em(0.3f);
    const ImVec2 end{corner.x + width, corner.y + ImGui::GetItemRectSize().y};
    const float rounding = ImGui::GetStyle().FrameRounding;
    if (lit) draw->AddRectFilled(corner, end, ImGui::GetColorU32(colours::raised), rounding);
    draw_swatch(studio, paint, {left, top}, side);
    if (worn) {
        draw->AddRect(
            corner, end, ImGui::GetColorU32(colours::text), rounding, 0, std::max(1.5f, em(0.1f)));
    }
    ImGui::PushFont(small_font());
    const float below = top + side + em(0.25f);
    centred_lines(fitted_lines(paint.name, width - em(0.3f), 2),
                  {corner.x, below},
                  width,
                  worn || lit ? colours::text : colours::dim_text);
    if (!distance.empty()) {
        centred_lines(
            {distance}, {corner.x, below + 2.3f * ImGui::GetFontSize()}, width, colours::text);
    }
    ImGui::PopFont();
}

void paint_tooltip(const Material& paint) {
    // Beside the column and at the bottom: hides neither swatches and their names nor the mock-up.
    const ImGuiViewport& window = *ImGui::GetMainViewport();
    const float bottom = window.WorkPos.y + window.WorkSize.y - em(3.0f);
    ImGui::SetNextWindowPos(
        {ImGui::GetWindowPos().x - em(1.0f), bottom}, ImGuiCond_Always, {1.0f, 1.0f});
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(em(22.0f));
    heading(paint.name.c_str());
    ImGui::TextUnformatted(summary_of(paint).c_str());
    if (!paint.provenance.empty()) dim_text(paint.provenance);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

const Material* paint_named(Studio& studio, const std::string& name) {
    const auto& own = studio.session.document().paints;
    const auto found = std::find_if(
        own.begin(), own.end(), [&](const Material& paint) { return paint.name == name; });
    return found != own.end() ? &*found : current_library(studio).find(name);
}

bool swatch_row(Studio& studio, const Material* paint, const std::string& text, bool chosen) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float side = em(1.5f);
    const bool picked = ImGui::Selectable(
        ("##" + text).c_str(), chosen, 0, {ImGui::GetContentRegionAvail().x, side});
    if (!ImGui::IsItemVisible()) return picked;
    if (paint) draw_swatch(studio, *paint, corner, side);
    ImGui::GetWindowDrawList()->AddText(
        {corner.x + side + em(0.4f), corner.y + 0.5f * (side - ImGui::GetTextLineHeight())},
        ImGui::GetColorU32(colours::text),
        text.c_str());
    return picked;
}

void draw_paint_list(Studio& studio,
                     const std::string& search,
                     const std::string& prefix,
                     const std::string& chosen,
                     const std::function<void(const Material& paint, bool picked)>& offer) {
    const PaintLibrary& library = current_library(studio);
    for (const auto* paints :
         {&studio.session.document().paints, &library.users, &library.shipped, &library.media}) {
        ImGui::PushID(paints);  // the session's own may have a name of the library's
        for (const std::size_t k : find_paints(*paints, search, "")) {
            // A copy: picking may change the list.
            const Material paint = (*paints)[k];
            const bool picked = swatch_row(studio, &paint, paint.name, paint.name == chosen);
            name_last_item(prefix + ":" + paint.name);
            offer(paint, picked);
            if (picked) break;
        }
        ImGui::PopID();
    }
}

}  // namespace livery
