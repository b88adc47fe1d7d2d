// What the camera sees, what is shown, and the photographs so far.
#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <imgui.h>

#include "studio/capture/capture_panel.h"
#include "studio/studio.h"

namespace livery {

namespace {

using Doing = CaptureView::Doing;
using Picture = std::shared_ptr<const Image8>;

unsigned texture_in(CapturePanelState& state, const Picture& picture) {
    Texture2D& texture = state.textures[picture];
    if (!texture) texture = texture_of(*picture);
    return texture.name();
}

void forget_textures(CapturePanelState& state) {
    const CaptureView& view = state.view;
    std::erase_if(state.textures, [&](const auto& entry) {
        const Picture& picture = entry.first;
        return picture != view.live && picture != view.shown &&
               std::none_of(view.steps.begin(),
                            view.steps.end(),
                            [&](const CaptureStepView& step) { return step.finding == picture; }) &&
               std::none_of(view.tiles.begin(), view.tiles.end(), [&](const CaptureTile& tile) {
                   return tile.seen == picture;
               });
    });
}

/// Fitted into a box, with its name below the corner.
void draw_fitted(CapturePanelState& state,
                 const Picture& picture,
                 ImVec2 corner,
                 ImVec2 box,
                 const char* caption) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(
        corner, {corner.x + box.x, corner.y + box.y}, IM_COL32(18, 18, 18, 255), em(0.25f));
    if (picture) {
        const float scale = std::min(box.x / static_cast<float>(picture->width),
                                     box.y / static_cast<float>(picture->height));
        const float width = scale * static_cast<float>(picture->width),
                    height = scale * static_cast<float>(picture->height);
        const ImVec2 from{corner.x + 0.5f * (box.x - width), corner.y + 0.5f * (box.y - height)};
        draw.AddImage(
            imgui_texture(texture_in(state, picture)), from, {from.x + width, from.y + height});
    }
    const ImVec2 at{corner.x + em(0.5f), corner.y + em(0.35f)};
    const ImVec2 size = ImGui::CalcTextSize(caption);
    draw.AddRectFilled({at.x - em(0.25f), at.y - em(0.1f)},
                       {at.x + size.x + em(0.25f), at.y + size.y + em(0.1f)},
                       IM_COL32(0, 0, 0, 150),
                       em(0.2f));
    draw.AddText(at, ImGui::GetColorU32(colours::text), caption);
}

void draw_histogram(const CaptureHistogram& histogram, ImVec2 corner, ImVec2 box) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(
        corner, {corner.x + box.x, corner.y + box.y}, IM_COL32(18, 18, 18, 255), em(0.25f));
    const float bar = box.x / static_cast<float>(histogram.share.size());
    for (std::size_t k = 0; k < histogram.share.size(); ++k) {
        // The square root, so that the few bright pixels of a mock-up can be seen.
        const float height = std::sqrt(histogram.share[k]) * (box.y - em(1.6f));
        const float x = corner.x + static_cast<float>(k) * bar;
        const bool high = k + 2 >= histogram.share.size();
        draw.AddRectFilled({x, corner.y + box.y - height},
                           {x + bar - 1.0f, corner.y + box.y},
                           ImGui::GetColorU32(high ? colours::error : colours::dim_text));
    }
    const bool seen = std::any_of(
        histogram.share.begin(), histogram.share.end(), [](float share) { return share > 0.0f; });
    if (!seen) return;
    const std::string text =
        fmt::format("Histogram; {:.2f} % at full scale", 100.0 * histogram.clipped);
    draw.AddText({corner.x + em(0.5f), corner.y + em(0.3f)},
                 ImGui::GetColorU32(histogram.clipped > 0.001 ? colours::warning : colours::text),
                 text.c_str());
}

void draw_tiles(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const CaptureView& view = state.view;
    const ImVec2 tile{em(8.0f), em(5.4f)};
    const float label = em(1.3f);
    ImGui::BeginChild("tiles");
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
    bool first = true;
    for (std::size_t k = 0; k < view.tiles.size(); ++k) {
        if (!view.tiles[k].seen) continue;
        const CaptureTile& each = view.tiles[k];
        const float next = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + tile.x;
        if (!first && next < right) ImGui::SameLine();
        first = false;
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        ImGui::PushID(static_cast<int>(k));
        if (ImGui::InvisibleButton("tile", {tile.x, tile.y + label})) state.selected = k;
        name_last_item(fmt::format("tile:{}", k));
        const bool hovered = ImGui::IsItemHovered();
        tooltip(fmt::format("{}: {} photograph{}. Click to choose it.",
                            each.of,
                            each.photographs,
                            each.photographs == 1 ? "" : "s"));
        if (ImGui::IsRectVisible(corner, {corner.x + tile.x, corner.y + tile.y + label})) {
            ImDrawList& draw = *ImGui::GetWindowDrawList();
            draw.AddImage(imgui_texture(texture_in(state, each.seen)),
                          corner,
                          {corner.x + tile.x, corner.y + tile.y});
            ImGui::PushFont(small_font());
            draw.PushClipRect(corner, {corner.x + tile.x, corner.y + tile.y + label}, true);
            draw.AddText({corner.x, corner.y + tile.y},
                         ImGui::GetColorU32(colours::dim_text),
                         each.of.c_str());
            draw.PopClipRect();
            ImGui::PopFont();
            if (hovered || state.selected == k)
                draw.AddRect(
                    corner,
                    {corner.x + tile.x, corner.y + tile.y},
                    ImGui::GetColorU32(state.selected == k ? colours::accent : colours::line),
                    0.0f,
                    0,
                    2.0f);
        }
        ImGui::PopID();
    }
    if (view.doing == Doing::capturing && !state.selected) ImGui::SetScrollHereY(1.0f);
    ImGui::EndChild();
}

/// The row over the tiles.
void draw_tile_actions(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    const CaptureView& view = state.view;
    if (state.selected && *state.selected >= view.tiles.size()) state.selected.reset();
    dim_text(fmt::format(
        "{} photographs taken, {} kept from before", view.taken, view.kept_from_before));
    if (!state.selected) return;
    ImGui::SameLine();
    const std::string label = fmt::format("Take {} again", view.tiles[*state.selected].of);
    if (button(label, "take-again")) {
        studio.capture->take_again(*state.selected);
        state.selected.reset();
    }
}

/// What the newest step that is done has found; null: nothing to see.
const CaptureStepView* newest_finding(const CaptureView& view) {
    if (view.doing == Doing::capturing) return nullptr;
    for (auto step = view.steps.rbegin(); step != view.steps.rend(); ++step)
        if (step->done && step->finding) return &*step;
    return nullptr;
}

}  // namespace

bool draw_capture_stage(Studio& studio) {
    CapturePanelState& state = studio.panels.of<CapturePanelState>();
    if (!state.open) return false;
    const CaptureView& view = state.view;
    forget_textures(state);
    const ImVec2 space = ImGui::GetContentRegionAvail();
    const bool has_tiles = !view.tiles.empty();
    const bool by_hand = state.chosen && traits_of(*state.chosen).is_by_hand;
    const char* const live = by_hand ? "Photographs appear as they are copied"
                             : view.doing == Doing::nothing ? "No camera yet: choose one"
                             : view.doing == Doing::opening ? "Opening the camera"
                             : view.has_live_view           ? "Live view"
                                                            : "This camera gives no live view";
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float upper = has_tiles ? std::floor(0.42f * space.y) : space.y - em(6.0f);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    if (!has_tiles) {
        draw_fitted(state, view.live, corner, {space.x, upper}, live);
        draw_histogram(
            view.histogram, {corner.x, corner.y + upper + gap}, {space.x, em(6.0f) - gap});
        ImGui::Dummy(space);
        name_last_item("live-view");
        return true;
    }
    const float half = std::floor(0.5f * (space.x - gap));
    const bool capturing = view.doing == Doing::capturing;
    const float lower = em(5.0f);
    // What was found stands where a camera without a live view would show nothing.
    const CaptureStepView* found = newest_finding(view);
    const bool found_large = found && !view.has_live_view;
    draw_fitted(state,
                capturing     ? view.shown
                : found_large ? found->finding
                              : view.live,
                corner,
                {half, upper},
                capturing     ? "Shown"
                : found_large ? found->finding_of.c_str()
                              : live);
    Picture newest;
    std::string of = "Seen";
    const auto last =
        std::find_if(view.tiles.rbegin(), view.tiles.rend(), [](const auto& t) { return t.seen; });
    if (last != view.tiles.rend()) {
        newest = last->seen;
        of = "Seen: " + last->of;
    }
    if (found && !found_large) {
        newest = found->finding;
        of = found->finding_of;
    }
    const ImVec2 right{corner.x + half + gap, corner.y};
    draw_fitted(state, newest, right, {half, upper - lower - gap}, of.c_str());
    draw_histogram(view.histogram, {right.x, corner.y + upper - lower}, {half, lower});
    ImGui::Dummy({space.x, upper});
    name_last_item("live-view");
    draw_tile_actions(studio);
    draw_tiles(studio);
    return true;
}

}  // namespace livery
