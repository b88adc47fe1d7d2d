#include "evaluation/report/pdf_canvas.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <variant>

#include <pango/pangofc-fontmap.h>

#include "core/utf8.h"

namespace livery {

namespace {

cairo_status_t take_bytes(void* closure, const unsigned char* data, unsigned int length) try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
} catch (const std::exception&) {
    return CAIRO_STATUS_NO_MEMORY;
}

void set_colour(cairo_t* cairo, DrawingColour colour) {
    cairo_set_source_rgb(cairo,
                         (colour >> 16u & 255u) / 255.0,
                         (colour >> 8u & 255u) / 255.0,
                         (colour & 255u) / 255.0);
}

double points_of(int units) { return static_cast<double>(units) / PANGO_SCALE; }

/// Draws marks at a place and a scale.
class MarkPainter {
  public:
    MarkPainter(PdfCanvas& canvas, cairo_t* cairo, double x, double y, double scale)
        : canvas_(canvas), cairo_(cairo), x_(x), y_(y), scale_(scale) {}

    void operator()(const DrawnLine& line) const {
        trace({line.from, line.to});
        paint({}, line.colour, line.width, line.dash);
    }
    void operator()(const DrawnShape& shape) const {
        trace(shape.points);
        cairo_close_path(cairo_);
        paint(shape.fill, shape.stroke, shape.width, 0.0);
    }
    void operator()(const DrawnDot& dot) const {
        cairo_new_path(cairo_);
        cairo_arc(cairo_,
                  x_ + scale_ * dot.centre.x,
                  y_ + scale_ * dot.centre.y,
                  scale_ * dot.radius,
                  0.0,
                  6.283185307179586);
        cairo_close_path(cairo_);
        paint(dot.fill, dot.stroke, dot.width, 0.0);
    }
    void operator()(const DrawnText& text) const {
        PdfTextStyle style;
        style.size = text.size * scale_;
        style.colour = text.colour;
        style.weight = text.bold ? 600 : 400;
        style.anchor = text.anchor;
        style.on_baseline = true;
        canvas_.text(x_ + scale_ * text.at.x, y_ + scale_ * text.at.y, text.text, style);
    }

  private:
    void trace(const std::vector<DrawingPoint>& points) const {
        cairo_new_path(cairo_);
        for (const DrawingPoint& point : points) {
            cairo_line_to(cairo_, x_ + scale_ * point.x, y_ + scale_ * point.y);
        }
    }
    void paint(const std::optional<DrawingColour>& fill,
               const std::optional<DrawingColour>& stroke,
               double width,
               double dash) const {
        if (fill) {
            set_colour(cairo_, *fill);
            stroke ? cairo_fill_preserve(cairo_) : cairo_fill(cairo_);
        }
        if (stroke) {
            set_colour(cairo_, *stroke);
            cairo_set_line_width(cairo_, width * scale_);
            const double length = dash * scale_;
            cairo_set_dash(cairo_, &length, length > 0.0 ? 1 : 0, 0.0);
            cairo_stroke(cairo_);
        }
        cairo_new_path(cairo_);
    }
    PdfCanvas& canvas_;
    cairo_t* cairo_;
    double x_, y_, scale_;
};

}  // namespace

PdfCanvas::PdfCanvas(const char* fonts,
                     const ReportDocument& document,
                     double width,
                     double height) {
    // The shipped font, whatever is installed; the system's fonts for all other letters.
    config_.reset(FcInitLoadConfigAndFonts());
    if (!config_) throw std::runtime_error("fontconfig's settings, which cannot be read");
    FcConfigAppFontAddDir(config_.get(), reinterpret_cast<const FcChar8*>(fonts));
    fonts_.reset(pango_cairo_font_map_new_for_font_type(CAIRO_FONT_TYPE_FT));
    if (!fonts_) throw std::runtime_error("a Pango without FreeType");
    pango_fc_font_map_set_config(PANGO_FC_FONT_MAP(fonts_.get()), config_.get());
    // A point is a point.
    pango_cairo_font_map_set_resolution(PANGO_CAIRO_FONT_MAP(fonts_.get()), 72.0);

    surface_.reset(cairo_pdf_surface_create_for_stream(take_bytes, &bytes_, width, height));
    const auto describe = [&](cairo_pdf_metadata_t what, const std::string& text) {
        cairo_pdf_surface_set_metadata(surface_.get(), what, printable(text).c_str());
    };
    describe(CAIRO_PDF_METADATA_TITLE, document.title);
    describe(CAIRO_PDF_METADATA_CREATOR, document.made_by);
    describe(CAIRO_PDF_METADATA_CREATE_DATE, document.made_at);
    cairo_.reset(cairo_create(surface_.get()));
    GObjectOwner<PangoContext> context(pango_font_map_create_context(fonts_.get()));
    pango_cairo_update_context(cairo_.get(), context.get());
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context.get(), options);
    cairo_font_options_destroy(options);
    pango_context_set_round_glyph_positions(context.get(), FALSE);
    pango_context_set_language(context.get(), pango_language_from_string("en"));
    layout_.reset(pango_layout_new(context.get()));
    PangoAttrList* attributes = pango_attr_list_new();
    pango_attr_list_insert(attributes, pango_attr_font_features_new("tnum=1"));
    pango_attr_list_insert(attributes, pango_attr_insert_hyphens_new(FALSE));
    pango_layout_set_attributes(layout_.get(), attributes);
    pango_attr_list_unref(attributes);
    pango_layout_set_wrap(layout_.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_spacing(layout_.get(), 0);
    parents_.assign(4, CAIRO_PDF_OUTLINE_ROOT);
}

PangoLayout* PdfCanvas::laid_out(const std::string& text, const PdfTextStyle& style) const {
    PangoLayout* layout = layout_.get();
    PangoFontDescription* font = pango_font_description_from_string("Inter, Sans");
    pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
    pango_font_description_set_weight(font, static_cast<PangoWeight>(style.weight));
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    pango_layout_set_width(
        layout, style.width > 0.0 ? static_cast<int>(std::ceil(style.width * PANGO_SCALE)) : -1);
    pango_layout_set_ellipsize(layout, style.one_line ? PANGO_ELLIPSIZE_END : PANGO_ELLIPSIZE_NONE);
    pango_layout_set_line_spacing(layout, style.width > 0.0 ? 1.12f : 0.0f);
    pango_layout_set_alignment(layout,
                               style.anchor == TextAnchor::end      ? PANGO_ALIGN_RIGHT
                               : style.anchor == TextAnchor::middle ? PANGO_ALIGN_CENTER
                                                                    : PANGO_ALIGN_LEFT);
    // Names in scripts from right to left stand where others do.
    pango_layout_set_auto_dir(layout, TRUE);
    pango_layout_set_text(layout, printable(text).c_str(), -1);
    return layout;
}

TextSize PdfCanvas::size_of(const std::string& text, const PdfTextStyle& style) const {
    PangoRectangle logical;
    pango_layout_get_extents(laid_out(text, style), nullptr, &logical);
    return {points_of(logical.width), points_of(logical.height)};
}

void PdfCanvas::text(double x, double y, const std::string& text, const PdfTextStyle& style) {
    PangoLayout* layout = laid_out(text, style);
    unknown_ += pango_layout_get_unknown_glyphs_count(layout);
    // Without a width the anchor is the text's own.
    if (style.width <= 0.0 && style.anchor != TextAnchor::start) {
        PangoRectangle logical;
        pango_layout_get_extents(layout, nullptr, &logical);
        x -= points_of(logical.width) * (style.anchor == TextAnchor::middle ? 0.5 : 1.0);
    }
    if (style.on_baseline) y -= points_of(pango_layout_get_baseline(layout));
    set_colour(cairo_.get(), style.colour);
    cairo_move_to(cairo_.get(), x, y);
    pango_cairo_show_layout(cairo_.get(), layout);
    cairo_new_path(cairo_.get());
}

void PdfCanvas::line(DrawingPoint from, DrawingPoint to, DrawingColour colour, double width) {
    MarkPainter(*this, cairo_.get(), 0.0, 0.0, 1.0)(DrawnLine{from, to, colour, width});
}

void PdfCanvas::picture(double x, double y, double width, double height, const Image8& rgb) {
    const auto image = std::unique_ptr<cairo_surface_t, Releaser<cairo_surface_destroy>>(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, rgb.width, rgb.height));
    if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) return;
    cairo_surface_flush(image.get());
    unsigned char* to = cairo_image_surface_get_data(image.get());
    const int stride = cairo_image_surface_get_stride(image.get());
    for (int row = 0; row < rgb.height; ++row) {
        for (int column = 0; column < rgb.width; ++column) {
            const auto channel = [&](int c) { return std::uint32_t{rgb.at(column, row, c)}; };
            const std::uint32_t pixel = channel(0) << 16u | channel(1) << 8u | channel(2);
            std::memcpy(to + static_cast<std::ptrdiff_t>(row) * stride + 4 * column, &pixel, 4);
        }
    }
    cairo_surface_mark_dirty(image.get());
    cairo_save(cairo_.get());
    cairo_translate(cairo_.get(), x, y);
    cairo_scale(cairo_.get(), width / rgb.width, height / rgb.height);
    cairo_set_source_surface(cairo_.get(), image.get(), 0.0, 0.0);
    // Painting everything drops what a page began with, a tag's beginning as well.
    cairo_rectangle(cairo_.get(), 0.0, 0.0, rgb.width, rgb.height);
    cairo_fill(cairo_.get());
    cairo_restore(cairo_.get());
}

void PdfCanvas::drawing(double x, double y, double scale, const VectorDrawing& drawing) {
    const MarkPainter painter(*this, cairo_.get(), x, y, scale);
    for (const auto& mark : drawing.marks) std::visit(painter, mark);
}

void PdfCanvas::bookmark(int level, const std::string& text, int page, double y) {
    const auto at = static_cast<std::size_t>(std::clamp(level, 1, 3));
    const std::string place =
        "page=" + std::to_string(page) + " pos=[0 " + std::to_string(std::lround(y)) + "]";
    parents_[at] = cairo_pdf_surface_add_outline(surface_.get(),
                                                 parents_[at - 1],
                                                 printable(text).c_str(),
                                                 place.c_str(),
                                                 CAIRO_PDF_OUTLINE_FLAG_OPEN);
}

std::string PdfCanvas::finish() {
    const cairo_status_t drawn = cairo_status(cairo_.get());
    cairo_surface_finish(surface_.get());
    const cairo_status_t written = cairo_surface_status(surface_.get());
    const cairo_status_t status = drawn != CAIRO_STATUS_SUCCESS ? drawn : written;
    if (status != CAIRO_STATUS_SUCCESS) throw std::runtime_error(cairo_status_to_string(status));
    return std::move(bytes_);
}

}  // namespace livery
