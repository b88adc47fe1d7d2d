// A report as one HTML file that asks nothing of anybody: no script, no font, no other file.
#pragma once

#include <string>

#include "evaluation/report/report_document.h"

namespace livery {

/// UTF-8; everything that comes from elsewhere is escaped. Prints on A4.
std::string html_of(const ReportDocument& document);

/// A drawing as an `<svg>` element; title and description are for screen readers, `id` is
/// the document's own.
std::string svg_of(const VectorDrawing& drawing,
                   const std::string& title,
                   const std::string& description,
                   const std::string& id);

}  // namespace livery
