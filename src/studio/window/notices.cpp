// What the operator must know, in the stage's upper left corner: what, why, what to do.
#include <imgui.h>

#include "studio/kit/theme.h"
#include "studio/studio.h"
#include "studio/window/layout.h"

namespace livery {

namespace {

const ImVec4& colour_of(Notice::Level level) {
    switch (level) {
        case Notice::Level::error:
            return colours::error;
        case Notice::Level::warning:
            return colours::warning;
        case Notice::Level::info:
            break;
    }
    return colours::text;
}

/// True when it was dismissed.
bool draw_notice(const Notice& notice, float width) {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.ChannelsSplit(2);
    list.ChannelsSetCurrent(1);
    ImGui::BeginGroup();
    ImGui::Dummy({width, em(0.2f)});
    ImGui::Indent(em(0.9f));
    const float button = ImGui::GetFrameHeight();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width - em(1.8f) - button);
    ImGui::PushStyleColor(ImGuiCol_Text, colour_of(notice.level));
    ImGui::TextUnformatted(notice.what.c_str());
    ImGui::PopStyleColor();
    for (const std::string& text : {notice.cause, notice.fix}) {
        if (text.empty()) continue;
        ImGui::PushStyleColor(ImGuiCol_Text, colours::dim_text);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    ImGui::Unindent(em(0.9f));
    ImGui::Dummy({width, em(0.2f)});
    ImGui::EndGroup();
    const ImVec2 low = from, high = ImGui::GetItemRectMax();
    const ImVec2 after = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({low.x + width - button - em(0.2f), low.y + em(0.2f)});
    ImGui::PushStyleColor(ImGuiCol_Button, {0, 0, 0, 0});
    const bool dismissed = ImGui::Button("×", {button, button});
    ImGui::PopStyleColor();
    name_last_item("dismiss-notice");
    ImGui::SetCursorScreenPos(after);
    list.ChannelsSetCurrent(0);
    list.AddRectFilled(low, {low.x + width, high.y}, IM_COL32(46, 46, 46, 245), em(0.3f));
    list.AddRectFilled(
        low, {low.x + em(0.25f), high.y}, ImGui::GetColorU32(colour_of(notice.level)), em(0.15f));
    list.ChannelsMerge();
    return dismissed;
}

}  // namespace

void draw_notices(Studio& studio) {
    auto& notices = studio.notices;
    std::erase_if(notices, [&](const Notice& n) {
        return n.shown_until_s > 0.0 && n.shown_until_s <= studio.now_s;
    });
    if (notices.empty()) return;
    const float width = em(25.0f);
    ImGui::SetNextWindowPos({studio.stage_x + em(0.7f), studio.stage_y + em(0.7f)});
    ImGui::SetNextWindowBgAlpha(0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::Begin("##notices",
                 nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove);
    std::size_t dismissed = notices.size();
    constexpr std::size_t most_shown = 4;
    const std::size_t first = notices.size() > most_shown ? notices.size() - most_shown : 0;
    for (std::size_t i = first; i < notices.size(); ++i) {
        // Over a camera's live view news can wait
        if (is_open(studio, "capture") && notices[i].level == Notice::Level::info) continue;
        ImGui::PushID(static_cast<int>(i));
        if (draw_notice(notices[i], width)) dismissed = i;
        ImGui::PopID();
    }
    if (dismissed < notices.size())
        notices.erase(notices.begin() + static_cast<std::ptrdiff_t>(dismissed));
    ImGui::End();
    ImGui::PopStyleVar(2);
}

}  // namespace livery
