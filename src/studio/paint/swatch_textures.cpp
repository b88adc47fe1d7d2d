#include "studio/paint/swatch_textures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include "appearance/parameter_table.h"
#include "gl/window.h"
#include "studio/kit/widgets.h"
#include "studio/paint/library_panel.h"
#include "studio/paint/paint_finder.h"

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

void take_swatches(Studio& studio) {
    LibraryPanelState& state = *studio.panels.library;
    std::map<std::string, Image8> drawn;
    {
        const std::scoped_lock lock(state.inbox->mutex);
        drawn.swap(state.inbox->drawn);
    }
    if (state.swatches.size() + drawn.size() > kMostKept) {
        state.swatches.clear();
        state.asked.clear();
    }
    for (const auto& [key, picture] : drawn) {
        state.asked.erase(key);
        if (picture.channels != 4 || picture.empty()) continue;
        Texture2D texture(TextureShape{picture.width, picture.height, 0, 1},
                          TexelFormat::rgba8,
                          TexelFilter::linear);
        texture.upload(std::span<const std::uint8_t>(picture.values));
        state.swatches.insert_or_assign(key, std::move(texture));
    }
}

void draw_swatch(Studio& studio, const Material& material, const ImVec2& corner, float side_px) {
    LibraryPanelState& state = *studio.panels.library;
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
            {
                const std::scoped_lock lock(inbox->mutex);
                inbox->drawn[key] = rgba;
            }
            wake_main_thread();
        });
}

}  // namespace livery
