// What livery_pdf.so offers: the only code that links Cairo and Pango. pdf_canvas.cpp opens it when
// the first PDF is written. Only plain data crosses this line; an exception never does.
#pragma once

#include <cstddef>
#include <cstdint>

namespace livery {

/// One line, cut when longer.
struct PdfError {
    char text[512] = "";
};

struct PdfTextStyle {
    double size = 9.5;         ///< points
    double width = 0.0;        ///< lines are broken there; 0: never
    std::uint32_t colour = 0;  ///< 0xRRGGBB
    int weight = 400;          ///< 400 to 700
    int anchor = 0;            ///< 0: set to the left; 1: about the middle; 2: to the right
    bool on_baseline = false;  ///< `y` is the first line's baseline, else the top
};

struct PdfPen {
    bool has_fill = false, has_stroke = false;
    std::uint32_t fill = 0, stroke = 0;  ///< 0xRRGGBB
    double width = 1.0, dash = 0.0;
};

/// Points, y down, from the page's top left corner. All strings are UTF-8.
struct PdfTable {
    /// Null and the reason when it cannot. `fonts` is a folder with Inter, which is embedded, as is
    /// whatever stands in for letters that it has not. `date` is ISO 8601.
    void* (*open)(const char* fonts,
                  const char* title,
                  const char* creator,
                  const char* date,
                  double width,
                  double height,
                  PdfError*);
    void (*measure)(
        void* pdf, const char* text, const PdfTextStyle*, double* width, double* height);
    void (*text)(void* pdf, double x, double y, const char* text, const PdfTextStyle*);
    /// x and y in turn; an open line or, with `closed`, an area.
    void (*path)(void* pdf, const double* points, std::size_t count, bool closed, const PdfPen*);
    void (*dot)(void* pdf, double x, double y, double radius, const PdfPen*);
    /// Rows of RGB.
    void (*picture)(void* pdf,
                    double x,
                    double y,
                    double width,
                    double height,
                    const std::uint8_t* rgb,
                    int columns,
                    int rows);
    /// The structure that screen readers go by: "H1", "P", "Table", "TR", "TH", "TD", "Figure".
    void (*begin_tag)(void* pdf, const char* name);
    void (*end_tag)(void* pdf, const char* name);
    /// An entry of the outline that leads to the current page, level 1 to 3.
    void (*bookmark)(void* pdf, int level, const char* text, int page, double y);
    void (*end_page)(void* pdf);
    /// Hands all bytes to `sink` in one piece, and says how many characters no font at hand has;
    /// false and the reason when it cannot.
    bool (*finish)(void* pdf,
                   void (*sink)(void* context, const void* bytes, std::size_t size),
                   void* context,
                   int* unknown_characters,
                   PdfError*);
    void (*close)(void* pdf);
};

inline constexpr const char* kPdfTableSymbol = "livery_pdf_table";

}  // namespace livery
