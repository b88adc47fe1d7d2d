// Rows of the paint panel: the chosen paint in another colour, typed or one of a file of colour
// chips; a translucent paint's medium as a person thinks of it, one length and one colour, with its
// albedo; and what a person reads and types of a paint.
#pragma once

#include "appearance/fit/recolour.h"
#include "appearance/material.h"
#include "appearance/material_library.h"
#include "appearance/paint_colour.h"
#include "appearance/parameter_table.h"
#include "studio/studio.h"

namespace livery {

struct PaintColourState {
    std::string text;  ///< in the field
    bool typing = false, edited = false;
    std::vector<ColourChip> chips;
    std::string chips_file;
    std::optional<Recoloured> made;  ///< the last that was worked out
    std::vector<double> made_of;     ///< of that paint in that colour
};

/// Two rows. Tries the colour on the mock-up while it is typed or pointed at; `paint` is what the
/// panel shows.
void draw_paint_colour_row(Studio& studio, const Material& paint);

/// What the panel does around each control.
struct MediumRowCalls {
    std::function<void(const char* label, const std::string& meaning)> label;
    /// The item just drawn edits the paint; `name` may be empty for one that has a name.
    std::function<void(const std::string& name)> after_item;
};

/// Rows that change `edited`, which has a medium. `product_scale` as Product's: what a length of
/// the product is on the mock-up is said in words.
void draw_medium_rows(Material& edited, double product_scale, const MediumRowCalls& calls);

/// "Nine tenths of the light leave within 1.4 mm on the mock-up."
std::string reach_in_words(const Material& translucent, double product_scale);

/// "nm", or nothing, by the parameter's name.
std::string unit_of(const ParameterInfo& parameter);

/// "Clear coat", and the model's parameters that are not at their usual value, a line each.
std::string summary_of(const Material& material);

/// Why a paint cannot be drawn (a colour outside the working space); nothing when it can.
std::optional<std::string> paint_problem(const Material& material);

/// The library's paint that a session's own began as: "solid red 2" -> "solid red". Null: none.
const Material* library_origin(const std::string& name, const PaintLibrary& library);

}  // namespace livery
