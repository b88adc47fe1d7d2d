#include "studio/looks/look_thumbnails.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "studio/users_library.h"

namespace livery {

namespace {

constexpr int kLargest_px = 512;

void take_finished(LookThumbnailState& state) {
    for (const auto& [name, picture] : state.inbox->take()) {
        if (picture.channels != 4 || picture.empty()) continue;
        state.pictures.insert_or_assign(name, texture_of(picture));
    }
}

/// The light is the preview's, so the look's environment need not be read.
std::optional<Scene> scene_of_paints(const Studio& studio, const SessionLook& look) {
    Document document = studio.session.document();
    for (SessionLook& other : document.looks) other.look.environment = {};
    try {
        return scene_of(document, look.id, studio.product);
    } catch (const std::exception&) {
        return std::nullopt;  // Told where the look itself is drawn.
    }
}

void ask_for(Studio& studio, const SessionLook& look, const glm::ivec2& size_px) {
    LookThumbnailState& state = studio.panels.of<LookThumbnailState>();
    const std::string key =
        fmt::format("{} {} {}", studio.session.revision(), size_px.x, size_px.y);
    std::string& asked = state.asked[look.look.name];
    if (asked == key || !studio.previews || !studio.product || studio.opening) return;
    const auto scene = scene_of_paints(studio, look);
    if (scene) {
        // Looks that were not shown yet may wear paints that are files.
        const auto unread = unread_files(*scene);
        if (!unread.empty()) return refresh_library(studio, unread);
    }
    asked = key;
    if (!scene) return;
    const View view = eye_view(eye_in_use_mm(studio.session.document()),
                               bounds_of(studio.product->mesh),
                               size_px.x,
                               size_px.y);
    studio.previews->request_thumbnail(
        *scene, view, [inbox = state.inbox, name = look.look.name](const Image8& rgba) {
            inbox->put(name, rgba);
        });
}

}  // namespace

const SessionLook* look_named(const Document& document, const std::string& name) {
    for (const SessionLook& look : document.looks) {
        if (look.look.name == name) return &look;
    }
    return nullptr;
}

void draw_look_thumbnail(Studio& studio,
                         const std::string& look_name,
                         const ImVec2& corner,
                         const ImVec2& size) {
    LookThumbnailState& state = studio.panels.of<LookThumbnailState>();
    take_finished(state);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{corner.x + size.x, corner.y + size.y};
    list.AddRectFilled(corner, end, IM_COL32(18, 18, 18, 255), em(0.2f));
    if (const SessionLook* look = look_named(studio.session.document(), look_name)) {
        // Twice as fine as it is shown: its edges are smooth then.
        const auto px = [](float length) {
            return std::clamp(static_cast<int>(std::lround(length)), 16, kLargest_px);
        };
        ask_for(studio, *look, {px(2.0f * size.x), px(2.0f * size.y)});
    }
    const auto found = state.pictures.find(look_name);
    if (found == state.pictures.end()) return;
    list.AddImage(imgui_texture(found->second.name()), corner, end);
}

}  // namespace livery
