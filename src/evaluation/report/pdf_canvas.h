// A PDF that is drawn page by page, with Cairo and Pango. Of the module livery_pdf.so alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <cairo-pdf.h>
#include <fontconfig/fontconfig.h>
#include <pango/pangocairo.h>

#include "core/image.h"
#include "evaluation/report/report_document.h"

namespace livery {

struct PdfTextStyle {
    double size = 9.5;   ///< points
    double width = 0.0;  ///< lines are broken there; 0: never
    DrawingColour colour = kInkColour;
    int weight = 400;  ///< 400 to 700
    TextAnchor anchor = TextAnchor::start;
    bool on_baseline = false;  ///< `y` is the first line's baseline, else the top
    bool one_line = false;     ///< what is wider than `width` ends with "…"
};

struct TextSize {
    double width = 0.0, height = 0.0;
};

/// Points, y down, from the page's top left corner. What no page can show (control characters,
/// bytes that are not UTF-8) becomes "?".
class PdfCanvas {
  public:
    /// Pages of `width` x `height`. `fonts` is a folder with Inter, which is embedded, as is
    /// whatever stands in for letters that it has not. Throws std::runtime_error.
    PdfCanvas(const char* fonts, const ReportDocument& document, double width, double height);

    TextSize size_of(const std::string& text, const PdfTextStyle& style) const;
    void text(double x, double y, const std::string& text, const PdfTextStyle& style);
    void line(DrawingPoint from, DrawingPoint to, DrawingColour colour, double width);
    void picture(double x, double y, double width, double height, const Image8& rgb);
    void drawing(double x, double y, double scale, const VectorDrawing& drawing);
    /// The structure that screen readers go by: "H1", "P", "Table", "TR", "TH", "TD", "Figure".
    void begin_tag(const char* name) { cairo_tag_begin(cairo_.get(), name, nullptr); }
    void end_tag(const char* name) { cairo_tag_end(cairo_.get(), name); }
    /// An entry of the outline that leads to the current page, level 1 to 3.
    void bookmark(int level, const std::string& text, int page, double y);
    void end_page() { cairo_show_page(cairo_.get()); }
    /// All bytes; nothing may be drawn after it. Throws std::runtime_error.
    std::string finish();
    int unknown_characters() const { return unknown_; }

  private:
    template <auto release>
    struct Releaser {
        template <typename T>
        void operator()(T* what) const {
            release(what);
        }
    };
    template <typename T>
    using GObjectOwner = std::unique_ptr<T, Releaser<g_object_unref>>;
    PangoLayout* laid_out(const std::string& text, const PdfTextStyle& style) const;

    std::string bytes_;
    std::unique_ptr<FcConfig, Releaser<FcConfigDestroy>> config_;
    GObjectOwner<PangoFontMap> fonts_;
    std::unique_ptr<cairo_surface_t, Releaser<cairo_surface_destroy>> surface_;
    std::unique_ptr<cairo_t, Releaser<cairo_destroy>> cairo_;
    GObjectOwner<PangoLayout> layout_;
    int unknown_ = 0;           ///< characters that no font has
    std::vector<int> parents_;  ///< of the outline: the newest entry of each level
};

}  // namespace livery
