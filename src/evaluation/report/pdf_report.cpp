// A report as PDF: pages of A4, its fonts embedded, with an outline and a structure for screen
// readers. The module livery_pdf.so, which alone links Cairo and Pango.
#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "evaluation/report/pdf_canvas.h"

namespace livery {

namespace {

constexpr double kPageWidth = 595.276, kPageHeight = 841.890;  // A4
constexpr double kLeft = 56.6, kTop = 54.0, kBottom = kPageHeight - 58.0;
constexpr double kWidth = kPageWidth - 2.0 * kLeft;
constexpr double kCellSize = 8.2, kCellGap = 9.0, kCellMargin = 3.2;

PdfTextStyle style_of(double size,
                      int weight = 400,
                      DrawingColour colour = kInkColour,
                      double width = kWidth) {
    PdfTextStyle style;
    style.size = size;
    style.weight = weight;
    style.colour = colour;
    style.width = width;
    return style;
}

/// Widths of a table's columns, and what they are made from.
class ColumnWidths {
  public:
    ColumnWidths(const PdfCanvas& canvas, const ReportTable& table) {
        const PdfTextStyle head = style_of(kCellSize, 600, kInkColour, 0.0);
        const PdfTextStyle cell = style_of(kCellSize, 400, kInkColour, 0.0);
        for (std::size_t k = 0; k < table.columns.size(); ++k) {
            // A title may be broken between words.
            double widest = 0.0;
            const std::string& title = table.columns[k].title;
            for (std::size_t at = 0; at < title.size();) {
                const std::size_t end = std::min(title.find(' ', at), title.size());
                widest = std::max(widest, canvas.size_of(title.substr(at, end - at), head).width);
                at = end + 1;
            }
            for (const auto& row : table.rows) {
                widest = std::max(widest, canvas.size_of(row[k], cell).width);
            }
            // What a line is broken at may round.
            widths.push_back(widest + 0.8);
        }
        std::vector<double> whole_titles;
        for (const ReportColumn& column : table.columns) {
            whole_titles.push_back(canvas.size_of(column.title, head).width + 0.8);
        }
        fit(table, kWidth - kCellGap * static_cast<double>(widths.size() - 1), whole_titles);
    }
    std::vector<double> widths;

  private:
    double sum() const {
        double all = 0.0;
        for (const double width : widths) all += width;
        return all;
    }

    void fit(const ReportTable& table, double room, const std::vector<double>& whole_titles) {
        if (double left = room - sum(); left >= 0.0) {
            for (std::size_t k = 0; k < widths.size(); ++k) {
                const double more = std::clamp(whole_titles[k] - widths[k], 0.0, left);
                widths[k] += more;
                left -= more;
            }
            // Numbers stay close to what they are of, unless that is all there is.
            widths.front() += std::min(left, 60.0);
            return;
        }
        shrink(
            room, [&](std::size_t k) { return !table.columns[k].number; }, 64.0);
        shrink(
            room, [](std::size_t) { return true; }, 20.0);
    }

    /// Cuts the widest of those chosen, down to `least`, until all have room.
    template <typename Chosen>
    void shrink(double room, const Chosen& chosen, double least) {
        for (double excess = sum() - room; excess > 1e-6; excess = sum() - room) {
            double widest = least, next = least;
            int count = 0;
            for (std::size_t k = 0; k < widths.size(); ++k) {
                if (!chosen(k) || widths[k] <= least) continue;
                if (widths[k] > widest + 1e-9) {
                    next = widest;
                    widest = widths[k];
                    count = 1;
                } else if (widths[k] > widest - 1e-9) {
                    ++count;
                } else {
                    next = std::max(next, widths[k]);
                }
            }
            if (count == 0) return;
            const double to = std::max(next, widest - excess / count);
            for (std::size_t k = 0; k < widths.size(); ++k) {
                if (chosen(k) && widths[k] > widest - 1e-9) widths[k] = to;
            }
        }
    }
};

class PdfWriter {
  public:
    /// `pages`: how many there will be, which a first writing tells.
    PdfWriter(const ReportDocument& document, const char* fonts, int pages)
        : document_(document), pages_(pages), canvas_(fonts, document, kPageWidth, kPageHeight) {}

    PdfFile written() {
        paragraph("H1", document_.title, style_of(21.0, 600), 3.0);
        paragraph("P", document_.subtitle, style_of(9.5, 400, kSoftInkColour), 14.0);
        for (std::size_t k = 0; k < document_.blocks.size(); ++k) {
            next_ = k + 1 < document_.blocks.size() ? &document_.blocks[k + 1] : nullptr;
            std::visit(*this, document_.blocks[k]);
        }
        end_page();
        PdfFile file;
        file.bytes = canvas_.finish();
        file.unknown_characters = canvas_.unknown_characters();
        file.pages = page_;
        return file;
    }

    void operator()(const ReportHeading& heading) {
        const bool second = heading.level <= 2;
        const PdfTextStyle style = style_of(second ? 14.0 : 10.5, 600);
        const double height = canvas_.size_of(heading.text, style).height;
        if (second && y_ > kTop) y_ += 14.0;
        // Never alone at the end of a page.
        room_for(height + 6.0 + company());
        if (second && y_ > kTop) {
            canvas_.line({kLeft, y_ - 6.0}, {kLeft + kWidth, y_ - 6.0}, kGridColour, 0.7);
        }
        canvas_.bookmark(second ? 1 : 2, heading.text, page_, y_);
        paragraph(second ? "H2" : "H3", heading.text, style, 6.0);
    }

    void operator()(const ReportParagraph& text) {
        if (text.role == ParagraphRole::note) {
            return paragraph("P", text.text, style_of(8.2, 400, kSoftInkColour), 9.0);
        }
        if (text.role == ParagraphRole::body) {
            return paragraph("P", text.text, style_of(9.5), 7.0);
        }
        constexpr double indent = 14.0;
        const PdfTextStyle style = style_of(12.5, 600, kInkColour, kWidth - indent);
        const double height = canvas_.size_of(text.text, style).height;
        room_for(height + 20.0);
        y_ += 5.0;
        canvas_.line({kLeft + 1.5, y_ - 2.0}, {kLeft + 1.5, y_ + height + 2.0}, kStrongColour, 3.0);
        tagged_text("P", kLeft + indent, text.text, style);
        y_ += height + 14.0;
    }

    void operator()(const ReportChart& chart) {
        const PdfTextStyle title = style_of(10.5, 600);
        const PdfTextStyle note = style_of(8.2, 400, kSoftInkColour);
        const double scale = kWidth / chart.drawing.width;
        const double title_height = canvas_.size_of(chart.title, title).height;
        const double note_height = canvas_.size_of(chart.note, note).height;
        room_for(chart_height(chart));
        canvas_.bookmark(2, chart.title, page_, y_);
        tagged_text("H3", kLeft, chart.title, title);
        y_ += title_height + 9.0;
        canvas_.begin_tag("Figure");
        canvas_.drawing(kLeft, y_, scale, chart.drawing);
        canvas_.end_tag("Figure");
        y_ += scale * chart.drawing.height + 6.0;
        tagged_text("P", kLeft, chart.note, note);
        y_ += note_height + 18.0;
    }

    void operator()(const ReportPictures& row) {
        constexpr double gap = 14.0;
        constexpr double width = 0.5 * (kWidth - gap);
        const PdfTextStyle style = style_of(8.5, 400, kSoftInkColour, width);
        for (std::size_t first = 0; first < row.pictures.size(); first += 2) {
            double tallest = 0.0;
            const std::size_t end = std::min(first + 2, row.pictures.size());
            const auto height_of = [&](const ReportPicture& picture) {
                return width * picture.pixels.height / picture.pixels.width;
            };
            for (std::size_t k = first; k < end; ++k) {
                tallest = std::max(tallest,
                                   height_of(row.pictures[k]) + 4.0 +
                                       canvas_.size_of(row.pictures[k].caption, style).height);
            }
            room_for(tallest);
            for (std::size_t k = first; k < end; ++k) {
                const ReportPicture& picture = row.pictures[k];
                const double x = kLeft + static_cast<double>(k - first) * (width + gap);
                canvas_.begin_tag("Figure");
                canvas_.picture(x, y_, width, height_of(picture), picture.pixels);
                canvas_.text(x, y_ + height_of(picture) + 4.0, picture.caption, style);
                canvas_.end_tag("Figure");
            }
            y_ += tallest + 12.0;
        }
    }

    void operator()(const ReportTable& table) {
        const ColumnWidths columns(canvas_, table);
        std::vector<std::string> titles;
        for (const ReportColumn& column : table.columns) titles.push_back(column.title);
        const double head_height = row_height(titles, columns.widths, 600);
        const double first_row =
            table.rows.empty() ? 0.0 : row_height(table.rows.front(), columns.widths, 400);
        const PdfTextStyle caption = style_of(10.5, 600);
        const double caption_height = canvas_.size_of(table.caption, caption).height;
        y_ += 4.0;
        // What is short stays together.
        double rows_height = 0.0;
        for (const auto& row : table.rows) rows_height += row_height(row, columns.widths, 400);
        if (rows_height > 0.4 * (kBottom - kTop)) rows_height = 2.0 * first_row;
        room_for(caption_height + 5.0 + head_height + rows_height);
        tagged_text("P", kLeft, table.caption, caption);
        y_ += caption_height + 5.0;
        canvas_.begin_tag("Table");
        draw_row(table, titles, columns.widths, true);
        for (const auto& row : table.rows) {
            if (y_ + row_height(row, columns.widths, 400) > kBottom) {
                next_page();
                draw_row(table, titles, columns.widths, true);
            }
            draw_row(table, row, columns.widths, false);
        }
        canvas_.end_tag("Table");
        y_ += 5.0;
        if (!table.note.empty()) (*this)(ReportParagraph{table.note, ParagraphRole::note});
        y_ += 8.0;
    }

  private:
    double chart_height(const ReportChart& chart) const {
        return canvas_.size_of(chart.title, style_of(10.5, 600)).height + 9.0 +
               kWidth / chart.drawing.width * chart.drawing.height + 6.0 +
               canvas_.size_of(chart.note, style_of(8.2)).height;
    }

    /// What a heading needs of what follows it.
    double company() const {
        constexpr double some_lines = 110.0;
        const auto* chart = next_ ? std::get_if<ReportChart>(next_) : nullptr;
        const auto* pictures = next_ ? std::get_if<ReportPictures>(next_) : nullptr;
        if (chart) return chart_height(*chart);
        return pictures ? 0.5 * kWidth : some_lines;
    }

    void end_page() {
        PdfTextStyle style = style_of(7.5, 400, kSoftInkColour, 0.0);
        style.on_baseline = true;
        constexpr double baseline = kPageHeight - 30.0;
        const std::string number = fmt::format("{} / {}", page_, pages_);
        PdfTextStyle title = style;
        title.width = kWidth - canvas_.size_of(number, style).width - 20.0;
        title.one_line = true;
        canvas_.text(kLeft, baseline, document_.title, title);
        style.anchor = TextAnchor::end;
        canvas_.text(kLeft + kWidth, baseline, number, style);
        canvas_.end_page();
    }

    void next_page() {
        end_page();
        ++page_;
        y_ = kTop;
    }

    void room_for(double height) {
        if (y_ + height > kBottom && y_ > kTop) next_page();
    }

    void tagged_text(const char* tag,
                     double x,
                     const std::string& text,
                     const PdfTextStyle& style) {
        canvas_.begin_tag(tag);
        canvas_.text(x, y_, text, style);
        canvas_.end_tag(tag);
    }

    void paragraph(const char* tag,
                   const std::string& text,
                   const PdfTextStyle& style,
                   double after) {
        if (text.empty()) return;
        const double height = canvas_.size_of(text, style).height;
        room_for(height);
        tagged_text(tag, kLeft, text, style);
        y_ += height + after;
    }

    double row_height(const std::vector<std::string>& cells,
                      const std::vector<double>& widths,
                      int weight) const {
        double tallest = 0.0;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const PdfTextStyle style = style_of(kCellSize, weight, kInkColour, widths[k]);
            tallest = std::max(tallest, canvas_.size_of(cells[k], style).height);
        }
        return tallest + 2.0 * kCellMargin;
    }

    void draw_row(const ReportTable& table,
                  const std::vector<std::string>& cells,
                  const std::vector<double>& widths,
                  bool head) {
        const double height = row_height(cells, widths, head ? 600 : 400);
        double x = kLeft;
        canvas_.begin_tag("TR");
        for (std::size_t k = 0; k < cells.size(); ++k) {
            PdfTextStyle style = style_of(kCellSize, head ? 600 : 400, kInkColour, widths[k]);
            style.anchor = table.columns[k].number ? TextAnchor::end : TextAnchor::start;
            // Titles stand upon their line.
            const double text_height = canvas_.size_of(cells[k], style).height;
            const double top = head ? y_ + height - kCellMargin - text_height : y_ + kCellMargin;
            const char* tag = head || k == 0 ? "TH" : "TD";
            canvas_.begin_tag(tag);
            canvas_.text(x, top, cells[k], style);
            canvas_.end_tag(tag);
            x += widths[k] + kCellGap;
        }
        canvas_.end_tag("TR");
        y_ += height;
        const double end = x - kCellGap;
        canvas_.line({kLeft, y_}, {end, y_}, head ? kInkColour : kGridColour, head ? 1.0 : 0.6);
    }

    const ReportDocument& document_;
    const ReportBlock* next_ = nullptr;  ///< after the one that is being written
    int pages_ = 0, page_ = 1;
    double y_ = kTop;
    PdfCanvas canvas_;
};

}  // namespace

}  // namespace livery

/// What pdf_of() calls; no exception leaves it. False and the reason when it cannot.
extern "C" __attribute__((visibility("default"))) bool livery_write_pdf(
    const livery::ReportDocument& document,
    const char* fonts,
    livery::PdfFile& file,
    std::string& why);

bool livery_write_pdf(const livery::ReportDocument& document,
                      const char* fonts,
                      livery::PdfFile& file,
                      std::string& why) try {
    const int pages = livery::PdfWriter(document, fonts, 1).written().pages;
    file = livery::PdfWriter(document, fonts, pages).written();
    return true;
} catch (const std::exception& failure) {
    why = failure.what();
    return false;
}
