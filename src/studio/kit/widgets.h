// Controls that several panels share.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

struct ImVec2;
struct ImVec4;

namespace livery {

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

/// A bar with its fraction in words on top.
void progress_bar(double fraction, const std::string& text);

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

}  // namespace livery
