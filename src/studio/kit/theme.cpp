#include <algorithm>
#include <array>
#include <cmath>

#include <imgui.h>
#include <imgui_freetype.h>
#include <imgui_internal.h>

#include "core/paths.h"
#include "studio/kit/widgets.h"

namespace livery {

namespace colours {
const ImVec4 text{0.89f, 0.89f, 0.89f, 1.0f};
const ImVec4 dim_text{0.64f, 0.64f, 0.64f, 1.0f};
const ImVec4 accent{0.36f, 0.45f, 0.53f, 1.0f};
const ImVec4 panel{0.125f, 0.125f, 0.125f, 1.0f};
const ImVec4 raised{0.20f, 0.20f, 0.20f, 1.0f};
const ImVec4 line{0.24f, 0.24f, 0.24f, 1.0f};
const ImVec4 warning{0.93f, 0.70f, 0.32f, 1.0f};
const ImVec4 error{0.95f, 0.46f, 0.40f, 1.0f};
const ImVec4 good{0.55f, 0.76f, 0.56f, 1.0f};
}  // namespace colours

namespace {

constexpr float kTextPx = 15.0f;

// Dear ImGui has one atlas; what it was made from must live as long as it does.
struct Fonts {
    std::string regular, semi_bold;
    ImFont *heading = nullptr, *large = nullptr, *small = nullptr;
} fonts;

// First and last code points of what is drawn, closed by 0: Latin with all its extensions, Greek
// and Cyrillic as names and files may have them, punctuation, arrows and simple shapes.
constexpr std::array<ImWchar, 17> kTextGlyphs = {0x20,
                                                 0x24f,
                                                 0x2b0,
                                                 0x2ff,
                                                 0x370,
                                                 0x3ff,
                                                 0x400,
                                                 0x45f,
                                                 0x1e00,
                                                 0x1eff,
                                                 0x2000,
                                                 0x2150,
                                                 0x2190,
                                                 0x22ff,
                                                 0x25a0,
                                                 0x27bf,
                                                 0};
constexpr std::array<ImWchar, 9> kTitleGlyphs = {
    0x20, 0x24f, 0x2010, 0x2044, 0x2190, 0x21ff, 0x25a0, 0x25ff, 0};

ImFont* add_font(std::string& file, float size_px, const ImWchar* glyphs) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
    return ImGui::GetIO().Fonts->AddFontFromMemoryTTF(
        file.data(), static_cast<int>(file.size()), size_px, &config, glyphs);
}

void load_fonts(float scale) {
    if (fonts.regular.empty()) {
        fonts.regular = read_text_file(shipped_path("fonts/Inter-Regular.otf"));
        fonts.semi_bold = read_text_file(shipped_path("fonts/Inter-SemiBold.otf"));
    }
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    const auto size = [&](float px) { return std::round(px * scale); };
    add_font(fonts.regular, size(kTextPx), kTextGlyphs.data());
    fonts.heading = add_font(fonts.semi_bold, size(kTextPx), kTitleGlyphs.data());
    fonts.large = add_font(fonts.semi_bold, size(19.0f), kTitleGlyphs.data());
    fonts.small = add_font(fonts.regular, size(13.0f), kTextGlyphs.data());
}

ImVec4 grey(float value, float alpha = 1.0f) { return {value, value, value, alpha}; }

void set_colours(ImGuiStyle& style) {
    const auto set = [&](ImGuiCol what, const ImVec4& colour) { style.Colors[what] = colour; };
    ImVec4 accent_bright = colours::accent;
    accent_bright.x += 0.08f;
    accent_bright.y += 0.08f;
    accent_bright.z += 0.08f;
    set(ImGuiCol_Text, colours::text);
    set(ImGuiCol_TextDisabled, grey(0.50f));
    set(ImGuiCol_WindowBg, colours::panel);
    set(ImGuiCol_ChildBg, grey(0.0f, 0.0f));
    set(ImGuiCol_PopupBg, grey(0.155f));
    set(ImGuiCol_Border, colours::line);
    set(ImGuiCol_FrameBg, grey(0.225f));
    set(ImGuiCol_FrameBgHovered, grey(0.27f));
    set(ImGuiCol_FrameBgActive, grey(0.30f));
    set(ImGuiCol_TitleBg, grey(0.155f));
    set(ImGuiCol_TitleBgActive, grey(0.155f));
    set(ImGuiCol_TitleBgCollapsed, grey(0.155f));
    set(ImGuiCol_MenuBarBg, grey(0.155f));
    set(ImGuiCol_ScrollbarBg, grey(0.0f, 0.0f));
    set(ImGuiCol_ScrollbarGrab, grey(0.28f));
    set(ImGuiCol_ScrollbarGrabHovered, grey(0.36f));
    set(ImGuiCol_ScrollbarGrabActive, grey(0.42f));
    set(ImGuiCol_CheckMark, grey(0.85f));
    set(ImGuiCol_SliderGrab, grey(0.50f));
    set(ImGuiCol_SliderGrabActive, grey(0.68f));
    set(ImGuiCol_Button, grey(0.235f));
    set(ImGuiCol_ButtonHovered, grey(0.29f));
    set(ImGuiCol_ButtonActive, grey(0.33f));
    set(ImGuiCol_Header, colours::accent);
    set(ImGuiCol_HeaderHovered, grey(0.26f));
    set(ImGuiCol_HeaderActive, grey(0.31f));
    set(ImGuiCol_Separator, colours::line);
    set(ImGuiCol_SeparatorHovered, grey(0.40f));
    set(ImGuiCol_SeparatorActive, grey(0.50f));
    set(ImGuiCol_ResizeGrip, grey(0.0f, 0.0f));
    set(ImGuiCol_ResizeGripHovered, grey(0.36f));
    set(ImGuiCol_ResizeGripActive, grey(0.42f));
    set(ImGuiCol_Tab, grey(0.0f, 0.0f));
    set(ImGuiCol_TabHovered, grey(0.26f));
    set(ImGuiCol_TabActive, grey(0.25f));
    set(ImGuiCol_TabUnfocused, grey(0.0f, 0.0f));
    set(ImGuiCol_TabUnfocusedActive, grey(0.25f));
    set(ImGuiCol_PlotHistogram, accent_bright);
    set(ImGuiCol_PlotHistogramHovered, accent_bright);
    set(ImGuiCol_PlotLines, grey(0.75f));
    set(ImGuiCol_TableHeaderBg, grey(0.17f));
    set(ImGuiCol_TableBorderStrong, colours::line);
    set(ImGuiCol_TableBorderLight, grey(0.19f));
    set(ImGuiCol_TableRowBg, grey(0.0f, 0.0f));
    set(ImGuiCol_TableRowBgAlt, grey(1.0f, 0.025f));
    set(ImGuiCol_TextSelectedBg, colours::accent);
    set(ImGuiCol_DragDropTarget, accent_bright);
    set(ImGuiCol_NavHighlight, grey(0.80f));
    set(ImGuiCol_ModalWindowDimBg, grey(0.0f, 0.55f));
}

}  // namespace

void apply_theme(float scale) {
    load_fonts(scale);
    ImGuiStyle style;
    style.WindowPadding = {10.0f, 8.0f};
    style.FramePadding = {8.0f, 4.0f};
    style.ItemSpacing = {8.0f, 6.0f};
    style.ItemInnerSpacing = {6.0f, 4.0f};
    style.CellPadding = {6.0f, 3.0f};
    style.IndentSpacing = 16.0f;
    style.ScrollbarSize = 11.0f;
    style.GrabMinSize = 12.0f;
    style.WindowRounding = 6.0f;
    style.ChildRounding = 4.0f;
    style.FrameRounding = 4.0f;
    style.PopupRounding = 5.0f;
    style.ScrollbarRounding = 6.0f;
    style.GrabRounding = 3.0f;
    style.TabRounding = 4.0f;
    style.WindowBorderSize = 1.0f;
    style.PopupBorderSize = 1.0f;
    style.FrameBorderSize = 0.0f;
    style.TabBorderSize = 0.0f;
    style.WindowTitleAlign = {0.0f, 0.5f};
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.ColorButtonPosition = ImGuiDir_Left;
    style.DisabledAlpha = 0.42f;
    style.ScaleAllSizes(scale);
    style.WindowBorderSize = style.PopupBorderSize = std::max(1.0f, std::round(scale));
    set_colours(style);
    ImGui::GetStyle() = style;
}

ImFont* heading_font() { return fonts.heading; }
ImFont* large_font() { return fonts.large; }
ImFont* small_font() { return fonts.small; }

float em(float multiple) { return multiple * ImGui::GetFontSize(); }

void heading(const char* text) {
    ImGui::PushFont(fonts.heading);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::PopFont();
}

namespace {

void wrapped(const ImVec4& colour, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    // Where a width is set already (a tooltip's) the window's edge may not be known yet: it would
    // be as high as the screen in its first picture.
    const float set = ImGui::GetCurrentWindow()->DC.TextWrapPos;
    ImGui::PushTextWrapPos(std::max(set, 0.0f));
    ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

}  // namespace

void dim_text(const std::string& text) { wrapped(colours::dim_text, text); }
void warning_text(const std::string& text) { wrapped(colours::warning, text); }
void coloured_text(const ImVec4& colour, const std::string& text) { wrapped(colour, text); }

void row_label(const char* text, float share) {
    const float left = ImGui::GetCursorPosX();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(text);
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + std::floor(width * share));
    ImGui::SetNextItemWidth(width - std::floor(width * share));
}

void tooltip(const std::string& text) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    // A text has no id, and without one nothing counts how long the pointer rests on it.
    if (g.HoveredId == 0) ImGui::SetHoveredID(ImGui::GetID(text.c_str()));
    if (g.HoveredIdTimer < kTooltipAfter_s) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(em(24.0f));
    ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void begin_disabled(bool disabled) { ImGui::BeginDisabled(disabled); }
void end_disabled() { ImGui::EndDisabled(); }

bool toggle_button(const char* label, bool on, float width) {
    if (on) {
        ImGui::PushStyleColor(ImGuiCol_Button, colours::accent);
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colours::accent);
        ImGui::PushStyleColor(ImGuiCol_ButtonActive, colours::accent);
    }
    const bool pressed = ImGui::Button(label, {width, 0.0f});
    if (on) ImGui::PopStyleColor(3);
    return pressed;
}

}  // namespace livery
