// A report as PDF: pages of A4, its fonts embedded, with an outline and a structure for screen
// readers.
#pragma once

#include <string>

#include "evaluation/report/report_document.h"

namespace livery {

struct PdfFile {
    std::string bytes;
    int pages = 0;
    int unknown_characters = 0;  ///< that no font at hand has: they stand as boxes
};

/// Throws FileError where the part of Livery that writes PDF, or the font, is not there.
PdfFile pdf_of(const ReportDocument& document);

}  // namespace livery
