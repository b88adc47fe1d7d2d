// How the window looks: colours, spacing, fonts. Neutral greys, because the pictures are judged
// beside them; one muted accent.
#pragma once

#include <string>

struct ImFont;
struct ImVec4;

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

}  // namespace livery
