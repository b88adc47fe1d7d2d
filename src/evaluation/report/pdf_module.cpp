#include "evaluation/report/pdf_module.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <cairo-pdf.h>
#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>
#include <pango/pangofc-fontmap.h>

namespace {

using livery::PdfError;
using livery::PdfPen;
using livery::PdfTable;
using livery::PdfTextStyle;

template <auto release>
struct Releaser {
    template <typename T>
    void operator()(T* what) const {
        release(what);
    }
};
using Surface = std::unique_ptr<cairo_surface_t, Releaser<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Releaser<cairo_destroy>>;
template <typename T>
using GObjectOwner = std::unique_ptr<T, Releaser<g_object_unref>>;
using FontConfig = std::unique_ptr<FcConfig, Releaser<FcConfigDestroy>>;

struct Pdf {
    std::string bytes;
    FontConfig config;
    GObjectOwner<PangoFontMap> fonts;
    Surface surface;
    Context cairo;
    GObjectOwner<PangoLayout> layout;
    int unknown = 0;
    std::vector<int> parents;  ///< of the outline: the newest entry of each level
};

void say(PdfError* error, const char* text) {
    std::strncpy(error->text, text, sizeof(error->text) - 1);
    std::replace(error->text, error->text + std::strlen(error->text), '\n', ' ');
}

cairo_status_t take_bytes(void* closure, const unsigned char* data, unsigned int length) try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
} catch (const std::exception&) {
    return CAIRO_STATUS_NO_MEMORY;
}

void set_colour(cairo_t* cairo, std::uint32_t colour) {
    cairo_set_source_rgb(cairo,
                         (colour >> 16u & 255u) / 255.0,
                         (colour >> 8u & 255u) / 255.0,
                         (colour & 255u) / 255.0);
}

void* open(const char* fonts,
           const char* title,
           const char* creator,
           const char* date,
           double width,
           double height,
           PdfError* error) try {
    auto pdf = std::make_unique<Pdf>();
    // The shipped font, whatever is installed; the system's fonts for all other letters.
    pdf->config.reset(FcInitLoadConfigAndFonts());
    if (!pdf->config) {
        say(error, "fontconfig's settings, which cannot be read");
        return nullptr;
    }
    FcConfigAppFontAddDir(pdf->config.get(), reinterpret_cast<const FcChar8*>(fonts));
    pdf->fonts.reset(pango_cairo_font_map_new_for_font_type(CAIRO_FONT_TYPE_FT));
    if (!pdf->fonts) {
        say(error, "a Pango without FreeType");
        return nullptr;
    }
    pango_fc_font_map_set_config(PANGO_FC_FONT_MAP(pdf->fonts.get()), pdf->config.get());
    // A point is a point.
    pango_cairo_font_map_set_resolution(PANGO_CAIRO_FONT_MAP(pdf->fonts.get()), 72.0);

    pdf->surface.reset(cairo_pdf_surface_create_for_stream(take_bytes, &pdf->bytes, width, height));
    cairo_pdf_surface_set_metadata(pdf->surface.get(), CAIRO_PDF_METADATA_TITLE, title);
    cairo_pdf_surface_set_metadata(pdf->surface.get(), CAIRO_PDF_METADATA_CREATOR, creator);
    cairo_pdf_surface_set_metadata(pdf->surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, date);
    pdf->cairo.reset(cairo_create(pdf->surface.get()));
    GObjectOwner<PangoContext> context(pango_font_map_create_context(pdf->fonts.get()));
    pango_cairo_update_context(pdf->cairo.get(), context.get());
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context.get(), options);
    cairo_font_options_destroy(options);
    pango_context_set_round_glyph_positions(context.get(), FALSE);
    pango_context_set_language(context.get(), pango_language_from_string("en"));
    pdf->layout.reset(pango_layout_new(context.get()));
    PangoAttrList* attributes = pango_attr_list_new();
    pango_attr_list_insert(attributes, pango_attr_font_features_new("tnum=1"));
    pango_attr_list_insert(attributes, pango_attr_insert_hyphens_new(FALSE));
    pango_layout_set_attributes(pdf->layout.get(), attributes);
    pango_attr_list_unref(attributes);
    pango_layout_set_wrap(pdf->layout.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_spacing(pdf->layout.get(), 0);
    pdf->parents.assign(4, CAIRO_PDF_OUTLINE_ROOT);
    return pdf.release();
} catch (const std::exception& failure) {
    say(error, failure.what());
    return nullptr;
}

PangoLayout* laid_out(Pdf& pdf, const char* text, const PdfTextStyle& style) {
    PangoLayout* layout = pdf.layout.get();
    PangoFontDescription* font = pango_font_description_from_string("Inter, Sans");
    pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
    pango_font_description_set_weight(font, static_cast<PangoWeight>(style.weight));
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    pango_layout_set_width(
        layout, style.width > 0.0 ? static_cast<int>(std::ceil(style.width * PANGO_SCALE)) : -1);
    pango_layout_set_line_spacing(layout, style.width > 0.0 ? 1.12f : 0.0f);
    pango_layout_set_alignment(layout,
                               style.anchor == 2   ? PANGO_ALIGN_RIGHT
                               : style.anchor == 1 ? PANGO_ALIGN_CENTER
                                                   : PANGO_ALIGN_LEFT);
    // Names in scripts from right to left stand where others do.
    pango_layout_set_auto_dir(layout, TRUE);
    pango_layout_set_text(layout, text, -1);
    return layout;
}

double points_of(int units) { return static_cast<double>(units) / PANGO_SCALE; }

void measure(
    void* handle, const char* text, const PdfTextStyle* style, double* width, double* height) {
    PangoLayout* layout = laid_out(*static_cast<Pdf*>(handle), text, *style);
    PangoRectangle logical;
    pango_layout_get_extents(layout, nullptr, &logical);
    *width = points_of(logical.width);
    *height = points_of(logical.height);
}

void draw_text(void* handle, double x, double y, const char* text, const PdfTextStyle* style) {
    Pdf& pdf = *static_cast<Pdf*>(handle);
    PangoLayout* layout = laid_out(pdf, text, *style);
    pdf.unknown += pango_layout_get_unknown_glyphs_count(layout);
    // Without a width the anchor is the text's own.
    if (style->width <= 0.0 && style->anchor != 0) {
        PangoRectangle logical;
        pango_layout_get_extents(layout, nullptr, &logical);
        x -= points_of(logical.width) * (style->anchor == 1 ? 0.5 : 1.0);
    }
    if (style->on_baseline) y -= points_of(pango_layout_get_baseline(layout));
    set_colour(pdf.cairo.get(), style->colour);
    cairo_move_to(pdf.cairo.get(), x, y);
    pango_cairo_show_layout(pdf.cairo.get(), layout);
    cairo_new_path(pdf.cairo.get());
}

void paint_path(cairo_t* cairo, const PdfPen& pen) {
    if (pen.has_fill) {
        set_colour(cairo, pen.fill);
        pen.has_stroke ? cairo_fill_preserve(cairo) : cairo_fill(cairo);
    }
    if (pen.has_stroke) {
        set_colour(cairo, pen.stroke);
        cairo_set_line_width(cairo, pen.width);
        cairo_set_dash(cairo, &pen.dash, pen.dash > 0.0 ? 1 : 0, 0.0);
        cairo_stroke(cairo);
    }
    cairo_new_path(cairo);
}

void draw_path(
    void* handle, const double* points, std::size_t count, bool closed, const PdfPen* pen) {
    cairo_t* cairo = static_cast<Pdf*>(handle)->cairo.get();
    cairo_new_path(cairo);
    for (std::size_t k = 0; k < count; ++k) {
        cairo_line_to(cairo, points[2 * k], points[2 * k + 1]);
    }
    if (closed) cairo_close_path(cairo);
    paint_path(cairo, *pen);
}

void draw_dot(void* handle, double x, double y, double radius, const PdfPen* pen) {
    cairo_t* cairo = static_cast<Pdf*>(handle)->cairo.get();
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, radius, 0.0, 6.283185307179586);
    cairo_close_path(cairo);
    paint_path(cairo, *pen);
}

void draw_picture(void* handle,
                  double x,
                  double y,
                  double width,
                  double height,
                  const std::uint8_t* rgb,
                  int columns,
                  int rows) {
    cairo_t* cairo = static_cast<Pdf*>(handle)->cairo.get();
    const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, columns, rows));
    if (cairo_surface_status(image.get()) != CAIRO_STATUS_SUCCESS) return;
    cairo_surface_flush(image.get());
    unsigned char* to = cairo_image_surface_get_data(image.get());
    const int stride = cairo_image_surface_get_stride(image.get());
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column, rgb += 3) {
            const std::uint32_t pixel = static_cast<std::uint32_t>(rgb[0]) << 16u |
                                        static_cast<std::uint32_t>(rgb[1]) << 8u | rgb[2];
            std::memcpy(to + static_cast<std::ptrdiff_t>(row) * stride + 4 * column, &pixel, 4);
        }
    }
    cairo_surface_mark_dirty(image.get());
    cairo_save(cairo);
    cairo_translate(cairo, x, y);
    cairo_scale(cairo, width / columns, height / rows);
    cairo_set_source_surface(cairo, image.get(), 0.0, 0.0);
    // Painting everything drops what a page began with, a tag's beginning as well.
    cairo_rectangle(cairo, 0.0, 0.0, columns, rows);
    cairo_fill(cairo);
    cairo_restore(cairo);
}

void begin_tag(void* handle, const char* name) {
    cairo_tag_begin(static_cast<Pdf*>(handle)->cairo.get(), name, nullptr);
}

void end_tag(void* handle, const char* name) {
    cairo_tag_end(static_cast<Pdf*>(handle)->cairo.get(), name);
}

void bookmark(void* handle, int level, const char* text, int page, double y) {
    Pdf& pdf = *static_cast<Pdf*>(handle);
    const auto at = static_cast<std::size_t>(std::clamp(level, 1, 3));
    const std::string place =
        "page=" + std::to_string(page) + " pos=[0 " + std::to_string(std::lround(y)) + "]";
    pdf.parents[at] = cairo_pdf_surface_add_outline(
        pdf.surface.get(), pdf.parents[at - 1], text, place.c_str(), CAIRO_PDF_OUTLINE_FLAG_OPEN);
}

void end_page(void* handle) { cairo_show_page(static_cast<Pdf*>(handle)->cairo.get()); }

bool finish(void* handle,
            void (*sink)(void* context, const void* bytes, std::size_t size),
            void* context,
            int* unknown,
            PdfError* error) {
    Pdf& pdf = *static_cast<Pdf*>(handle);
    const cairo_status_t drawn = cairo_status(pdf.cairo.get());
    cairo_surface_finish(pdf.surface.get());
    const cairo_status_t written = cairo_surface_status(pdf.surface.get());
    const cairo_status_t status = drawn != CAIRO_STATUS_SUCCESS ? drawn : written;
    if (status != CAIRO_STATUS_SUCCESS) {
        say(error, cairo_status_to_string(status));
        return false;
    }
    *unknown = pdf.unknown;
    sink(context, pdf.bytes.data(), pdf.bytes.size());
    return true;
}

void close(void* handle) { delete static_cast<Pdf*>(handle); }

}  // namespace

extern "C" __attribute__((visibility("default"))) const livery::PdfTable* livery_pdf_table();

const livery::PdfTable* livery_pdf_table() {
    static constexpr PdfTable table{open,
                                    measure,
                                    draw_text,
                                    draw_path,
                                    draw_dot,
                                    draw_picture,
                                    begin_tag,
                                    end_tag,
                                    bookmark,
                                    end_page,
                                    finish,
                                    close};
    return &table;
}
