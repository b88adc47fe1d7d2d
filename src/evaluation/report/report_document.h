// What a report says, as blocks one after the other: written as HTML and as PDF from this alone.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/image.h"
#include "evaluation/report/vector_drawing.h"

namespace livery {

struct ReportHeading {
    int level = 2;  ///< 2 or 3; the title is 1
    std::string text;
};

enum class ParagraphRole {
    body,
    lead,  ///< what everybody should read
    note   ///< small: how to read something
};
struct ReportParagraph {
    std::string text;
    ParagraphRole role = ParagraphRole::body;
};

struct ReportColumn {
    std::string title;
    bool number = true;  ///< set to the right
};
/// The first cell of a row says what the row is of.
struct ReportTable {
    std::string caption;
    std::vector<ReportColumn> columns;
    std::vector<std::vector<std::string>> rows;  ///< as many cells as columns
    std::string note = {};
};

struct ReportChart {
    std::string title;
    std::string alternative;  ///< what it shows, for who does not see it
    std::string note;         ///< how to read it
    VectorDrawing drawing;
};

struct ReportPicture {
    std::string caption, alternative;
    Image8 pixels;  ///< RGB, sRGB
};
/// Beside one another, as many as fit.
struct ReportPictures {
    std::vector<ReportPicture> pictures;
};

using ReportBlock =
    std::variant<ReportHeading, ReportParagraph, ReportTable, ReportChart, ReportPictures>;

struct ReportDocument {
    std::string title, subtitle;
    std::string made_by;  ///< program and version
    std::string made_at;  ///< ISO 8601, UTC
    std::vector<ReportBlock> blocks;
};

/// UTF-8; everything that comes from elsewhere is escaped. Prints on A4.
std::string html_of(const ReportDocument& document);

/// A table for a terminal: caption, aligned columns, note.
std::string text_of(const ReportTable& table);

/// A drawing as an `<svg>` element; title and description are for screen readers, `id` is
/// the document's own.
std::string svg_of(const VectorDrawing& drawing,
                   const std::string& title,
                   const std::string& description,
                   const std::string& id);

struct PdfFile {
    std::string bytes;
    int pages = 0;
    int unknown_characters = 0;  ///< that no font at hand has: they stand as boxes
};

/// Throws FileError where the part of Livery that writes PDF, or the font, is not there.
PdfFile pdf_of(const ReportDocument& document);

}  // namespace livery
