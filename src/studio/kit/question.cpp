#include "studio/kit/question.h"

#include <algorithm>
#include <utility>

#include <imgui.h>

#include "studio/kit/theme.h"
#include "studio/kit/ui_map.h"
#include "studio/kit/widgets.h"

namespace livery {

void draw_question(std::optional<Question>& question) {
    if (!question) return;
    const std::string title = question->what + "###question";
    if (std::exchange(question->to_open, false)) ImGui::OpenPopup(title.c_str());
    const ImVec2 window = ImGui::GetMainViewport()->Size;
    ImGui::SetNextWindowSize({std::min(em(30.0f), 0.94f * window.x), 0.0f});
    ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(title.c_str(), nullptr, ImGuiWindowFlags_NoResize)) {
        question.reset();
        return;
    }
    ImGui::TextWrapped("%s", question->cause.c_str());
    ImGui::Dummy({0.0f, em(0.3f)});
    const float width = em(9.0f);
    ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 2.0f * width -
                         ImGui::GetStyle().ItemSpacing.x);
    const bool cancelled = ImGui::Button("Cancel", {width, 0.0f}) || was_pressed(ImGuiKey_Escape);
    name_last_item("question:cancel");
    ImGui::SameLine();
    const bool agreed = ImGui::Button(question->action.c_str(), {width, 0.0f});
    name_last_item("question:ok");
    std::function<void()> then;
    if (agreed && !cancelled) then = std::move(question->then);
    if (agreed || cancelled) {
        question.reset();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    // What comes of it may ask the next question.
    if (then) then();
}

}  // namespace livery
