#include "studio/kit/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <imgui.h>
#include <imgui_internal.h>

#include "core/colour.h"
#include "core/spectrum.h"
#include "studio/kit/ui_map.h"

namespace livery {

namespace {

constexpr ImGuiColorEditFlags kPicker =
    ImGuiColorEditFlags_NoSidePreview | ImGuiColorEditFlags_NoSmallPreview |
    ImGuiColorEditFlags_DisplayRGB | ImGuiColorEditFlags_DisplayHSV |
    ImGuiColorEditFlags_PickerHueWheel;

ImVec4 shown_colour(const glm::dvec3& linear) {
    const auto channel = [](double value) {
        return static_cast<float>(srgb_encode(std::clamp(value, 0.0, 1.0)));
    };
    return {channel(linear.x), channel(linear.y), channel(linear.z), 1.0f};
}

}  // namespace

unsigned screen_colour(const glm::dvec3& lab10) {
    return ImGui::GetColorU32(
        shown_colour(rec709_from_xyz() * xyz_from_xyz10(xyz10_from_lab10(lab10))));
}

namespace {

void picker_popup(const std::string& name, glm::dvec3& linear) {
    if (!ImGui::BeginPopup("picker")) return;
    const ImVec4 shown = shown_colour(linear);
    std::array<float, 3> encoded{shown.x, shown.y, shown.z};
    ImGui::SetNextItemWidth(em(14.0f));
    if (ImGui::ColorPicker3("##picker", encoded.data(), kPicker)) {
        for (int c = 0; c < 3; ++c) {
            linear[c] = srgb_decode(static_cast<double>(encoded[static_cast<std::size_t>(c)]));
        }
    }
    name_last_item(name + ":picker");
    ImGui::EndPopup();
}

void hex_field(const std::string& name, glm::dvec3& linear, float width) {
    std::array<char, 16> text{};
    const std::string shown = hex_of(linear);
    std::copy(shown.begin(), shown.end(), text.begin());
    ImGui::SetNextItemWidth(width);
    if (ImGui::InputText("##hex", text.data(), text.size(), ImGuiInputTextFlags_AutoSelectAll)) {
        const auto typed = colour_of_hex(text.data());
        // While "#a0" is being typed nothing is meant yet.
        if (typed && hex_of(*typed) != shown) linear = *typed;
    }
    name_last_item(name + ":hex");
}

/// The smallest value that a slider in equal ratios tells from 0.
constexpr double kSmallestRatio = 0.1;

/// Where between its ends a slider stands, 0 to 1.
double share_of(double value, double low, double high, bool in_ratios) {
    if (in_ratios) {
        const double floor = low > 0.0 ? low : kSmallestRatio;
        return std::log(std::max(value, floor) / floor) / std::log(high / floor);
    }
    return (value - low) / (high - low);
}

/// Draws an item with a number, `draw`, and over it the number as `shown`, in place of Dear
/// ImGui's, which has no thousands; while it is typed in, it is the item's own.
template <typename Draw>
void draw_with_text(const char* id, const std::string& shown, const Draw& draw) {
    const bool typed_before = ImGui::TempInputIsActive(ImGui::GetID(id));
    const ImU32 colour = ImGui::GetColorU32(ImGuiCol_Text);
    if (!typed_before) ImGui::PushStyleColor(ImGuiCol_Text, 0);
    draw();
    if (!typed_before) ImGui::PopStyleColor();
    if (ImGui::TempInputIsActive(ImGui::GetItemID())) return;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImVec2 size = ImGui::CalcTextSize(shown.c_str());
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->PushClipRect(low, high, true);
    list->AddText({std::floor(std::max(low.x + 2.0f, 0.5f * (low.x + high.x - size.x))),
                   std::floor(0.5f * (low.y + high.y - size.y))},
                  colour,
                  shown.c_str());
    list->PopClipRect();
}

/// A line along the bottom shows where it stands, so that the number stays legible.
void slider(
    const char* id, double& value, double low, double high, const char* format, bool in_ratios) {
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, 0);
    ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 1.0f);
    ImGui::SliderScalar(id,
                        ImGuiDataType_Double,
                        &value,
                        &low,
                        &high,
                        format,
                        (in_ratios ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None) |
                            ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor(2);
    const ImVec2 corner = ImGui::GetItemRectMin(), end = ImGui::GetItemRectMax();
    const auto share =
        static_cast<float>(std::clamp(share_of(value, low, high, in_ratios), 0.0, 1.0));
    const float line = std::max(2.0f, em(0.16f)), rounding = ImGui::GetStyle().FrameRounding;
    const float left = corner.x + rounding, right = end.x - rounding;
    const float at = left + share * (right - left);
    const bool lit = ImGui::IsItemActive() || ImGui::IsItemHovered();
    const ImU32 colour = ImGui::GetColorU32(lit ? colours::text : colours::dim_text);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(
        {left, end.y - line}, {at, end.y}, ImGui::GetColorU32(ImGuiCol_PlotHistogram));
    draw->AddRectFilled({at - 0.8f * line, end.y - 2.2f * line}, {at + 0.8f * line, end.y}, colour);
}

}  // namespace

bool named(bool answer, const std::string& name, const std::string& help) {
    name_last_item(name);
    if (!help.empty()) tooltip(help);
    return answer;
}

bool button(const std::string& label,
            const std::string& name,
            const std::string& help,
            float width) {
    return named(ImGui::Button(label.c_str(), {width, 0.0f}), name, help);
}

bool last_item_is_held() { return ImGui::IsItemActive(); }

void place_in_row(float width) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    if (ImGui::GetItemRectMax().x + gap + width <= right) ImGui::SameLine();
}

float button_width(const char* label) {
    return ImGui::CalcTextSize(label, nullptr, true).x + 2.0f * ImGui::GetStyle().FramePadding.x;
}

bool chip(const char* label, bool on) { return toggle_button(label, on, button_width(label)); }

std::vector<std::string> fitted_lines(const std::string& text, float width, std::size_t most) {
    const auto fits = [&](const std::string& line) {
        return ImGui::CalcTextSize(line.c_str()).x <= width;
    };
    std::vector<std::string> lines;
    std::size_t at = 0;
    while (at < text.size()) {
        const auto end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at);
        if (!lines.empty() && fits(lines.back() + " " + word)) {
            lines.back() += " " + word;
        } else {
            lines.push_back(word);
        }
        at = end + 1;
    }
    const bool too_many = lines.size() > most;
    if (too_many) lines.resize(most);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::string& line = lines[i];
        const bool more_follows = too_many && i + 1 == lines.size();
        if (fits(line) && !more_follows) continue;
        while (!line.empty() && !fits(line + "…")) {
            // Whole UTF-8 sequences.
            while (line.size() > 1 && (static_cast<unsigned char>(line.back()) & 0xc0u) == 0x80u) {
                line.pop_back();
            }
            line.pop_back();
        }
        line += "…";
    }
    return lines;
}

void centred_lines(const std::vector<std::string>& lines,
                   const ImVec2& top_left,
                   float width,
                   const ImVec4& colour) {
    float y = top_left.y;
    for (const std::string& line : lines) {
        const float line_width = ImGui::CalcTextSize(line.c_str()).x;
        ImGui::GetWindowDrawList()->AddText(
            {std::floor(top_left.x + 0.5f * (width - line_width)), y},
            ImGui::GetColorU32(colour),
            line.c_str());
        y += ImGui::GetFontSize() * 1.15f;
    }
}

void colour_control(const std::string& name, glm::dvec3& linear_rec709) {
    const float width = ImGui::CalcItemWidth();
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    ImGui::PushID(name.c_str());
    ImGui::BeginGroup();
    const float side = ImGui::GetFrameHeight();
    if (ImGui::ColorButton("##swatch",
                           shown_colour(linear_rec709),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                           {1.6f * side, side})) {
        ImGui::OpenPopup("picker");
    }
    name_last_item(name + ":swatch");
    ImGui::SameLine(0.0f, gap);
    hex_field(name, linear_rec709, width - 1.6f * side - gap);
    const float number = std::floor((width - 2.0f * gap) / 3.0f);
    constexpr std::array channels{"r", "g", "b"};
    for (int c = 0; c < 3; ++c) {
        if (c > 0) ImGui::SameLine(0.0f, gap);
        const std::string channel = channels[static_cast<std::size_t>(c)];
        ImGui::SetNextItemWidth(number);
        // Signed: paints leave the gamut of Rec.709.
        readable_drag(("##" + channel).c_str(), linear_rec709[c], 0.002f);
        name_last_item(name + ":" + channel);
    }
    if (!in_srgb(linear_rec709)) {
        ImGui::PushFont(small_font());
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
        ImGui::TextColored(colours::dim_text, "Outside sRGB: swatch and hex are clipped.");
        ImGui::PopTextWrapPos();
        ImGui::PopFont();
    }
    picker_popup(name, linear_rec709);
    ImGui::EndGroup();
    name_last_item(name);
    ImGui::PopID();
}

void ratio_slider(const char* id, double& value, double low, double high, const char* format) {
    slider(id, value, low, high, format, true);
}

void readable_slider(const char* id,
                     double& value,
                     double low,
                     double high,
                     const std::string& unit,
                     bool in_ratios) {
    const std::string shown = readable_number(value) + (unit.empty() ? "" : " " + unit);
    draw_with_text(id, shown, [&] { slider(id, value, low, high, "%.6g", in_ratios); });
}

void readable_drag(const char* id, double& value, float speed) {
    draw_with_text(id, readable_number(value), [&] {
        ImGui::DragScalar(id, ImGuiDataType_Double, &value, speed, nullptr, nullptr, "%.6g");
    });
}

void number_slider(const char* id, double& value, double low, double high, const char* format) {
    slider(id, value, low, high, format, false);
}

void vector_row(const char* label,
                const std::string& name,
                glm::dvec3& value,
                float speed,
                const char* format,
                const std::string& meaning,
                const std::function<void()>& after_item) {
    row_label(label);
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = std::floor((ImGui::CalcItemWidth() - 2.0f * gap) / 3.0f);
    constexpr std::array axes{"x", "y", "z"};
    for (int c = 0; c < 3; ++c) {
        const std::string axis = axes[static_cast<std::size_t>(c)];
        if (c > 0) ImGui::SameLine(0.0f, gap);
        ImGui::SetNextItemWidth(width);
        const std::string id = "##" + name + axis;
        if (format) {
            ImGui::DragScalar(
                id.c_str(), ImGuiDataType_Double, &value[c], speed, nullptr, nullptr, format);
        } else {
            readable_drag(id.c_str(), value[c], speed);
        }
        name_last_item(name + ":" + axis);
        tooltip(meaning);
        after_item();
    }
}

bool section_header(const char* label, bool* keep) {
    ImGui::PushStyleColor(ImGuiCol_Header, colours::raised);
    const bool open = ImGui::CollapsingHeader(label, keep);
    ImGui::PopStyleColor();
    return open;
}

bool begin_page(const char* title, bool& open, const ImVec2& size) {
    const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
    ImGui::SetNextWindowPos(
        ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Appearing, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(size.x, 0.92f * room.x), std::min(size.y, 0.9f * room.y)},
                             ImGuiCond_Appearing);
    return ImGui::Begin(
        title, &open, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
}

bool begin_modal(const std::string& title, float width, bool* open) {
    const ImGuiViewport& viewport = *ImGui::GetMainViewport();
    ImGui::SetNextWindowSize({std::min(width, 0.95f * viewport.Size.x), 0.0f});
    ImGui::SetNextWindowPos(viewport.GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
    return ImGui::BeginPopupModal(title.c_str(), open, ImGuiWindowFlags_NoResize);
}

void progress_bar(double fraction, const std::string& text) {
    ImGui::ProgressBar(
        static_cast<float>(std::clamp(fraction, 0.0, 1.0)), {-FLT_MIN, 0.0f}, text.c_str());
}

Image8 opaque(const Image8& rgb) {
    Image8 rgba(rgb.width, rgb.height, 4, 255);
    for (std::size_t i = 0; i < rgb.pixel_count(); ++i) {
        std::copy_n(&rgb.values[3 * i], 3, &rgba.values[4 * i]);
    }
    return rgba;
}

Texture2D texture_of(const Image8& picture, TexelWrap wrap) {
    Texture2D texture(TextureShape{picture.width, picture.height, 0, 1},
                      TexelFormat::rgba8,
                      TexelFilter::linear,
                      wrap);
    const auto& values = picture.channels == 4 ? picture.values : opaque(picture).values;
    texture.upload(std::span<const std::uint8_t>(values));
    return texture;
}

void* imgui_texture(unsigned name) {
    return reinterpret_cast<void*>(static_cast<std::uintptr_t>(name));
}

bool was_pressed(int imgui_key) {
    return ImGui::IsKeyPressed(ImGui::GetKeyIndex(static_cast<ImGuiKey>(imgui_key)));
}

}  // namespace livery
