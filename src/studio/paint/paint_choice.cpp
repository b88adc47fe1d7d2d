#include "studio/paint/paint_choice.h"

#include <algorithm>

#include <imgui.h>

#include "studio/kit/theme.h"
#include "studio/paint/swatches.h"
#include "studio/users_library.h"

namespace livery {

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
