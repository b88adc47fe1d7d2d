// A translucent paint's medium as a person thinks of it, one length and one colour, with its
// coefficients behind a fold.
#pragma once

#include <functional>
#include <string>

#include "appearance/material.h"

namespace livery {

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

}  // namespace livery
