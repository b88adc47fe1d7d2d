#include "studio/light/light_pad.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>
#include <imgui_internal.h>

#include "scene/frame_plan.h"
#include "studio/kit/imgui_versions.h"
#include "studio/kit/theme.h"
#include "studio/light/light_values.h"
#include "studio/studio.h"

namespace livery {

namespace {

struct Pad {
    ImVec2 centre;
    float radius;

    ImVec2 at(const glm::dvec2& pad) const {
        // What stands under the horizon is shown on the rim.
        const double length = glm::length(pad);
        const glm::dvec2 shown = length > 1.0 ? pad / length : pad;
        return {centre.x + radius * static_cast<float>(shown.x),
                centre.y + radius * static_cast<float>(shown.y)};
    }
    glm::dvec2 under(const ImVec2& mouse) const {
        return {static_cast<double>((mouse.x - centre.x) / radius),
                static_cast<double>((mouse.y - centre.y) / radius)};
    }
};

void draw_background(const Pad& pad, const glm::dvec3& toward_eye) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImU32 line = ImGui::GetColorU32(ImVec4(1.0f, 1.0f, 1.0f, 0.14f));
    draw->AddCircleFilled(
        pad.centre, pad.radius, ImGui::GetColorU32(ImGui::GetStyleColorVec4(ImGuiCol_FrameBg)), 64);
    for (const float ring : {1.0f / 3.0f, 2.0f / 3.0f, 1.0f}) {
        draw->AddCircle(pad.centre, ring * pad.radius, line, 64, std::max(1.0f, em(0.06f)));
    }
    if (glm::length(toward_eye) > 0.0) {
        const ImVec2 eye = pad.at(pad_from_angles(angles_of(toward_eye)));
        const float size = em(0.35f);
        draw->AddTriangle({eye.x, eye.y - size},
                          {eye.x - size, eye.y + 0.7f * size},
                          {eye.x + size, eye.y + 0.7f * size},
                          ImGui::GetColorU32(colours::dim_text),
                          std::max(1.0f, em(0.08f)));
    }
}

void draw_dot(const ImVec2& at, std::size_t light, const Angles& angles, bool lit) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float radius = em(0.52f);
    const ImU32 colour = ImGui::GetColorU32(lit ? ImVec4(1.0f, 1.0f, 1.0f, 1.0f) : colours::text);
    const bool below = angles.elevation_deg < 0.0;
    if (below) {
        draw->AddCircleFilled(at, radius, ImGui::GetColorU32(colours::panel), 24);
        draw->AddCircle(at, radius, colour, 24, std::max(1.0f, em(0.1f)));
    } else {
        draw->AddCircleFilled(at, radius, colour, 24);
    }
    const std::string number = fmt::format("{}", light + 1);
    const ImVec2 size = ImGui::CalcTextSize(number.c_str());
    draw->AddText({at.x - 0.5f * size.x, at.y - 0.5f * size.y},
                  below ? colour : ImGui::GetColorU32(colours::panel),
                  number.c_str());
}

}  // namespace

void light_pad(std::vector<DirectionalLight>& lights,
               const glm::dvec3& toward_eye,
               float side_px,
               const std::function<void()>& after_dot) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float margin = em(0.55f);
    const Pad pad{{corner.x + 0.5f * side_px, corner.y + 0.5f * side_px}, 0.5f * side_px - margin};
    draw_background(pad, toward_eye);
    ImGui::PushFont(small_font());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const ImVec2 at = pad.at(pad_from_angles(angles_of(lights[i].direction)));
        const float reach = em(0.7f);
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetCursorScreenPos({at.x - reach, at.y - reach});
        begin_overlapped_item();
        ImGui::InvisibleButton("dot", {2.0f * reach, 2.0f * reach});
        end_overlapped_item();
        if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1.0f)) {
            lights[i].direction = direction_of(angles_from_pad(pad.under(ImGui::GetIO().MousePos)));
            ImGui::MarkItemEdited(ImGui::GetItemID());
        }
        name_last_item(fmt::format("light-pad:{}", i));
        draw_dot(
            at, i, angles_of(lights[i].direction), ImGui::IsItemHovered() || ImGui::IsItemActive());
        after_dot();
        tooltip(
            fmt::format("The {} light. Pull it about: the middle is straight above, the rim the "
                        "horizon; the triangle is where the eye stands.",
                        light_name(i)));
        ImGui::PopID();
    }
    ImGui::PopFont();
    ImGui::SetCursorScreenPos(corner);
    ImGui::Dummy({side_px, side_px});
}

}  // namespace livery
