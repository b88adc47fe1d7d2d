// Controls, texts and colours that all panels share, and values as they say them. Neutral greys,
// because the pictures are judged beside them; one muted accent.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"
#include "gl/handles.h"

struct ImFont;
struct ImVec4;

struct ImVec2;

namespace livery {

/// Reads the fonts at this scale and sets style and colours. Call between frames; the backend's
/// font texture must be made anew afterwards. Throws FileError when a font is missing.
void apply_theme(float scale);

ImFont* heading_font();  ///< semi-bold, the text's size
ImFont* large_font();    ///< semi-bold, for states that must be read from afar
ImFont* small_font();

namespace colours {
extern const ImVec4 text, dim_text, accent, panel, raised, line, warning, error, good;
}

/// A panel's title, semi-bold, with space before it.
void heading(const char* text);
void dim_text(const std::string& text);                             ///< wrapped
void warning_text(const std::string& text);                         ///< wrapped
void coloured_text(const ImVec4& colour, const std::string& text);  ///< wrapped
/// "Eye distance" left, the next item right of it, `width` of the row's share for the label.
void row_label(const char* text, float share = 0.42f);
/// An explanation that shows when the pointer rests on the last item.
inline constexpr float kTooltipAfter_s = 0.5f;
void tooltip(const std::string& text);
/// Draws what a button cannot do yet in grey; pair with end_disabled().
void begin_disabled(bool disabled);
void end_disabled();
/// A button of the given width (0: by its text) that is filled with the accent while `on`.
bool toggle_button(const char* label, bool on, float width = 0.0f);
/// Lengths follow the scale: a multiple of the text's size.
float em(float multiple);

/// Names the item just drawn (name_last_item()) and says what it is for; hands on what it answered.
bool named(bool answer, const std::string& name, const std::string& help = "");
/// A named button; width 0: as wide as its label.
bool button(const std::string& label,
            const std::string& name,
            const std::string& help = "",
            float width = 0.0f);

/// Before an item of this width: on the same line if it fits, else on a new one.
void place_in_row(float width);
float button_width(const char* label);
/// A small toggle in a row that wraps.
bool chip(const char* label, bool on);

/// L*a*b* of the 10 degree observer as a screen shows it, packed for a draw list; what is brighter
/// than white is white.
unsigned screen_colour(const glm::dvec3& lab10);

/// At most `most` lines of the current font, broken at spaces; a text that needs more ends in an
/// ellipsis, and so does a word that is wider than a line.
std::vector<std::string> fitted_lines(const std::string& text, float width, std::size_t most);
void centred_lines(const std::vector<std::string>& lines,
                   const ImVec2& top_left,
                   float width,
                   const ImVec4& colour);

/// Fills the row: linear Rec.709 as a swatch that opens a picker, a hexadecimal sRGB field and
/// three numbers. One item for edit_with_last_item(). Values outside sRGB stay as they are until
/// they are changed, and are marked. Names its parts "NAME:swatch", "NAME:hex" and "NAME:r", ":g",
/// ":b".
void colour_control(const std::string& name, glm::dvec3& linear_rec709);

/// A slider in equal ratios; Ctrl+click types.
void ratio_slider(const char* id, double& value, double low, double high, const char* format);
void number_slider(const char* id, double& value, double low, double high, const char* format);

/// A slider whose value is shown as readable_number() writes it, with its unit (may be empty).
void readable_slider(const char* id,
                     double& value,
                     double low,
                     double high,
                     const std::string& unit,
                     bool in_ratios);
/// The same for a field that is dragged, without bounds.
void readable_drag(const char* id, double& value, float speed);

/// A row of three numbers to drag, named "NAME:x", ":y", ":z"; `after_item` is called after each.
void vector_row(const char* label,
                const std::string& name,
                glm::dvec3& value,
                float speed,
                const char* format,
                const std::string& meaning,
                const std::function<void()>& after_item);

/// A collapsing header in the panel's grey; `keep` (may be null) is set to false by its cross.
bool section_header(const char* label, bool* keep = nullptr);

/// A window over everything, in the middle when it appears; to be ended by ImGui::End().
bool begin_page(const char* title, bool& open, const ImVec2& size);
/// A dialog that has the window to itself, as high as what is in it.
bool begin_modal(const std::string& title, float width, bool* open = nullptr);

/// A bar with its fraction in words on top.
void progress_bar(double fraction, const std::string& text);

Image8 opaque(const Image8& rgb);  ///< with A, 255
/// Of 3 or 4 channels, as Dear ImGui draws it.
Texture2D texture_of(const Image8& picture, TexelWrap wrap = TexelWrap::clamp);
/// An OpenGL texture as Dear ImGui names it.
void* imgui_texture(unsigned name);

bool was_pressed(int imgui_key);  ///< ImGuiKey_..., with key repeat

bool last_item_is_held();  ///< the control just drawn has the mouse or the text cursor

template <typename Value>
class Held {
  public:
    /// At the start of the panel: what the controls show.
    Value& start(const Value& current) {
        if (!held_) value_ = current;
        held_now_ = false;
        return value_;
    }
    /// After each control.
    void after_item() { held_now_ = held_now_ || last_item_is_held(); }
    /// At the end of the panel.
    void finish() { held_ = held_now_; }
    bool is_held() const { return held_; }
    const Value& value() const { return value_; }  ///< while it is held

  private:
    Value value_{};
    bool held_ = false, held_now_ = false;
};

/// As people write it: 19650 is "19,650", 0.04251 "0.04251", 12.0 "12"; four digits below 1,000,
/// whole numbers above.
std::string readable_number(double value);

/// "12.3 ms", "4.87 s".
std::string milliseconds(double ms);

/// Begins with a capital and ends with a full stop.
std::string sentence(std::string text);

/// "2026-11-21T09:16:05Z" -> "2026-11-21 09:16 UTC". Other texts stay as they are.
std::string readable_time(const std::string& iso_8601);

/// A kept calibration's folder, "2026-11-21T09-16-13Z-397cfee1" -> "2026-11-21 09:16 · 397cfee1".
/// Other names stay as they are.
std::string readable_calibration(const std::string& folder_name);

/// "#a0b1c2" of linear Rec.709; channels outside [0, 1] are clipped (in_srgb() tells).
std::string hex_of(const glm::dvec3& linear_rec709);
bool in_srgb(const glm::dvec3& linear_rec709);
/// Linear Rec.709 of "#a0b1c2", "a0b1c2" or "#abc"; nothing when it is none of these.
std::optional<glm::dvec3> colour_of_hex(const std::string& text);

}  // namespace livery
