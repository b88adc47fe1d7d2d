// The paint library in words and figures: for the terminal, for scripts and for docs/materials.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "appearance/material.h"
#include "appearance/paint_figures.h"
#include "core/json.h"
#include "core/progress.h"
#include "ledger/paint_cost.h"

namespace livery {

struct ListedPaint {
    Material material;
    PaintFigures figures;
    PaintCost cost;
    std::optional<double> de00{};  ///< from the colour that was asked for
};

/// With their figures, in the same order. Throws FileError, Cancelled.
std::vector<ListedPaint> listed(const std::vector<Material>& paints, const Progress& progress);

/// A line a paint, under a line of headings.
std::string list_of(const std::vector<ListedPaint>& paints);
/// Every figure of one.
std::string page_of(const ListedPaint& paint);
Json json_of(const ListedPaint& paint);
/// The table of docs/materials.md.
std::string markdown_of(const std::vector<ListedPaint>& paints);

}  // namespace livery
