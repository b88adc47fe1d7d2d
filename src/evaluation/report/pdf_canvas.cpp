#include "evaluation/report/pdf_canvas.h"

#include "core/error.h"
#include "core/paths.h"
#include "core/system/module.h"
#include "core/utf8.h"

namespace livery {

namespace {

const PdfTable& pdf_table() {
    static const PdfTable& table = *reinterpret_cast<const PdfTable* (*)()>(
        symbol_of_module("livery_pdf.so", kPdfTableSymbol, "Livery's writer of PDF"))();
    return table;
}

/// What no page can show (control characters, bytes that are not UTF-8) becomes "?".
std::string shown(const std::string& text) { return printable(text); }

PdfPen pen_of(const std::optional<DrawingColour>& fill,
              const std::optional<DrawingColour>& stroke,
              double width,
              double dash) {
    return {
        fill.has_value(), stroke.has_value(), fill.value_or(0), stroke.value_or(0), width, dash};
}

/// Draws marks at a place and a scale.
class MarkPainter {
  public:
    MarkPainter(void* pdf, double x, double y, double scale)
        : pdf_(pdf), x_(x), y_(y), scale_(scale) {}

    void operator()(const DrawnLine& line) const {
        path({line.from, line.to},
             false,
             pen_of({}, line.colour, line.width * scale_, line.dash * scale_));
    }
    void operator()(const DrawnShape& shape) const {
        path(shape.points, true, pen_of(shape.fill, shape.stroke, shape.width * scale_, 0.0));
    }
    void operator()(const DrawnDot& dot) const {
        const PdfPen pen = pen_of(dot.fill, dot.stroke, dot.width * scale_, 0.0);
        pdf_table().dot(pdf_,
                        x_ + scale_ * dot.centre.x,
                        y_ + scale_ * dot.centre.y,
                        scale_ * dot.radius,
                        &pen);
    }
    void operator()(const DrawnText& text) const {
        PdfTextStyle style;
        style.size = text.size * scale_;
        style.colour = text.colour;
        style.weight = text.bold ? 600 : 400;
        style.anchor = static_cast<int>(text.anchor);
        style.on_baseline = true;
        pdf_table().text(pdf_,
                         x_ + scale_ * text.at.x,
                         y_ + scale_ * text.at.y,
                         shown(text.text).c_str(),
                         &style);
    }

  private:
    void path(const std::vector<DrawingPoint>& points, bool closed, const PdfPen& pen) const {
        std::vector<double> numbers;
        for (const DrawingPoint& point : points) {
            numbers.push_back(x_ + scale_ * point.x);
            numbers.push_back(y_ + scale_ * point.y);
        }
        pdf_table().path(pdf_, numbers.data(), points.size(), closed, &pen);
    }
    void* pdf_;
    double x_, y_, scale_;
};

}  // namespace

void PdfCanvas::Close::operator()(void* pdf) const { pdf_table().close(pdf); }

PdfCanvas::PdfCanvas(const std::string& title,
                     const std::string& creator,
                     const std::string& date,
                     double width,
                     double height) {
    const auto font = shipped_path("fonts/Inter-Regular.otf");
    PdfError error;
    pdf_.reset(pdf_table().open(font.parent_path().c_str(),
                                shown(title).c_str(),
                                shown(creator).c_str(),
                                date.c_str(),
                                width,
                                height,
                                &error));
    if (!pdf_) throw FileError("PDF", "", error.text, "fonts and a library that writes it");
}

TextSize PdfCanvas::size_of(const std::string& text, const PdfTextStyle& style) const {
    TextSize size;
    pdf_table().measure(pdf_.get(), shown(text).c_str(), &style, &size.width, &size.height);
    return size;
}

void PdfCanvas::text(double x, double y, const std::string& text, const PdfTextStyle& style) {
    pdf_table().text(pdf_.get(), x, y, shown(text).c_str(), &style);
}

void PdfCanvas::line(DrawingPoint from, DrawingPoint to, DrawingColour colour, double width) {
    MarkPainter(pdf_.get(), 0.0, 0.0, 1.0)(DrawnLine{from, to, colour, width});
}

void PdfCanvas::picture(double x, double y, double width, double height, const Image8& rgb) {
    check_argument(rgb.channels == 3, "PdfCanvas::picture: expected RGB");
    pdf_table().picture(pdf_.get(), x, y, width, height, rgb.values.data(), rgb.width, rgb.height);
}

void PdfCanvas::drawing(double x, double y, double scale, const VectorDrawing& drawing) {
    const MarkPainter painter(pdf_.get(), x, y, scale);
    for (const auto& mark : drawing.marks) std::visit(painter, mark);
}

void PdfCanvas::begin_tag(const char* name) { pdf_table().begin_tag(pdf_.get(), name); }
void PdfCanvas::end_tag(const char* name) { pdf_table().end_tag(pdf_.get(), name); }

void PdfCanvas::bookmark(int level, const std::string& text, int page, double y) {
    pdf_table().bookmark(pdf_.get(), level, shown(text).c_str(), page, y);
}

void PdfCanvas::end_page() { pdf_table().end_page(pdf_.get()); }

std::string PdfCanvas::finish(int& unknown_characters) {
    std::string bytes;
    PdfError error;
    const bool done = pdf_table().finish(
        pdf_.get(),
        [](void* context, const void* data, std::size_t size) {
            static_cast<std::string*>(context)->assign(static_cast<const char*>(data), size);
        },
        &bytes,
        &unknown_characters,
        &error);
    if (!done) throw FileError("PDF", "", error.text, "a document that can be written");
    return bytes;
}

}  // namespace livery
