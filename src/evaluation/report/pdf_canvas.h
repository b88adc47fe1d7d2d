// A PDF that is drawn page by page. The library behind it is loaded when first needed.
#pragma once

#include <memory>
#include <string>

#include "core/image.h"
#include "evaluation/report/pdf_module.h"
#include "evaluation/report/vector_drawing.h"

namespace livery {

struct TextSize {
    double width = 0.0, height = 0.0;
};

class PdfCanvas {
  public:
    /// Pages of `width` x `height` points. Throws FileError.
    PdfCanvas(const std::string& title,
              const std::string& creator,
              const std::string& date,
              double width,
              double height);

    TextSize size_of(const std::string& text, const PdfTextStyle& style) const;
    void text(double x, double y, const std::string& text, const PdfTextStyle& style);
    void line(DrawingPoint from, DrawingPoint to, DrawingColour colour, double width);
    void picture(double x, double y, double width, double height, const Image8& rgb);
    void drawing(double x, double y, double scale, const VectorDrawing& drawing);
    void begin_tag(const char* name);
    void end_tag(const char* name);
    void bookmark(int level, const std::string& text, int page, double y);
    void end_page();
    /// All bytes; nothing may be drawn after it. Throws FileError.
    std::string finish(int& unknown_characters);

  private:
    struct Close {
        void operator()(void* pdf) const;
    };
    std::unique_ptr<void, Close> pdf_;
};

}  // namespace livery
