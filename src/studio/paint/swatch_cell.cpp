#include "studio/paint/swatch_cell.h"

#include <algorithm>
#include <cmath>

#include "studio/kit/theme.h"
#include "studio/kit/widgets.h"
#include "studio/paint/paint_parameters.h"
#include "studio/paint/swatch_textures.h"

namespace livery {

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

}  // namespace livery
