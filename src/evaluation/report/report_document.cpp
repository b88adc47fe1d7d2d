#include "evaluation/report/report_document.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/paths.h"
#include "core/pictures/png_bytes.h"
#include "core/system/module.h"
#include "core/text/markup.h"

namespace livery {

namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { background: #eef1f4; color: #1d2430; margin: 0;
       font: 16px/1.55 Inter, system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif; }
main { background: #fff; max-width: 920px; margin: 2rem auto; padding: 3rem 3.5rem 3.5rem; border-radius: 6px;
       box-shadow: 0 1px 3px #1d243026; overflow-wrap: anywhere; }
h1 { font-size: 2rem; line-height: 1.2; font-weight: 650; letter-spacing: -.015em; margin: 0 0 .3rem; }
h2 { font-size: 1.3rem; line-height: 1.3; font-weight: 650; letter-spacing: -.01em; margin: 2.8rem 0 .7rem;
     padding-top: 1rem; border-top: 1px solid #d9dee5; }
h3 { font-size: 1.02rem; font-weight: 650; margin: 1.9rem 0 .4rem; }
p { margin: .5rem 0; max-width: 44rem; }
.subtitle, .note, figcaption { color: #545d6b; } .note, figcaption { font-size: .88rem; line-height: 1.5; }
.subtitle { margin: 0 0 1.6rem; }
.lead { font-size: 1.22rem; line-height: 1.45; font-weight: 500; border-left: 4px solid #123a63; padding: .1rem 0 .1rem 1.1rem;
        margin: 1.2rem 0; max-width: none; }
figure { margin: 1.4rem 0; } figure > svg { display: block; width: 100%; height: auto; margin: .3rem 0 .5rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; margin: 1.1rem 0 .4rem; font-size: .875rem; line-height: 1.4;
        font-variant-numeric: tabular-nums; overflow-wrap: normal; }
caption { text-align: left; font-weight: 650; font-size: 1.02rem; padding: .5rem 0 .5rem; caption-side: top; }
th, td { padding: .38rem .55rem; border-bottom: 1px solid #d9dee5; text-align: left; vertical-align: top; }
thead th { vertical-align: bottom; border-bottom: 1.5px solid #1d2430; font-weight: 600; }
tbody th { font-weight: 500; overflow-wrap: anywhere; min-width: 6rem; } th:first-child { padding-left: 0; }
.number { text-align: right; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(230px, 1fr)); gap: 1.2rem; margin: 1rem 0; }
.pictures figure { margin: 0; } .pictures img { width: 100%; height: auto; display: block; border-radius: 3px; }
footer { margin-top: 3rem; padding-top: 1rem; border-top: 1px solid #d9dee5; color: #545d6b; font-size: .85rem; }
@media (max-width: 640px) { main { margin: 0; padding: 1.4rem 1.1rem; border-radius: 0; } }
@page { size: A4; margin: 18mm 17mm 18mm; }
@media print {
  body { background: #fff; font-size: 10.5pt; } main { margin: 0; padding: 0; max-width: none; box-shadow: none; }
  h2, h3, caption { break-after: avoid; } figure, tr, .lead { break-inside: avoid; } thead { display: table-header-group; }
  .scroll { overflow: visible; } table { font-size: 8.5pt; }
}
)";

std::string hex(DrawingColour colour) { return fmt::format("#{:06x}", colour & 0xffffffu); }

std::string paint_of(const std::optional<DrawingColour>& fill,
                     const std::optional<DrawingColour>& stroke,
                     double width) {
    std::string text = fmt::format("fill=\"{}\"", fill ? hex(*fill) : "none");
    if (stroke) text += fmt::format(" stroke=\"{}\" stroke-width=\"{:g}\"", hex(*stroke), width);
    return text;
}

std::string mark_of(const DrawnLine& line) {
    return fmt::format(
        "<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" stroke=\"{}\" stroke-width=\"{:g}\"{}/>\n",
        line.from.x,
        line.from.y,
        line.to.x,
        line.to.y,
        hex(line.colour),
        line.width,
        line.dash > 0.0 ? fmt::format(" stroke-dasharray=\"{:g}\"", line.dash) : "");
}

std::string mark_of(const DrawnShape& shape) {
    std::string path;
    for (const DrawingPoint& point : shape.points) {
        path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", point.x, point.y);
    }
    return fmt::format(
        "<path d=\"{}Z\" {}/>\n", path, paint_of(shape.fill, shape.stroke, shape.width));
}

std::string mark_of(const DrawnDot& dot) {
    return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\" {}/>\n",
                       dot.centre.x,
                       dot.centre.y,
                       dot.radius,
                       paint_of(dot.fill, dot.stroke, dot.width));
}

std::string mark_of(const DrawnText& text) {
    static constexpr std::array anchors = {"start", "middle", "end"};
    return fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:g}\" fill=\"{}\" "
        "text-anchor=\"{}\"{}>{}</text>\n",
        text.at.x,
        text.at.y,
        text.size,
        hex(text.colour),
        anchors[static_cast<std::size_t>(text.anchor)],
        text.bold ? " font-weight=\"650\"" : "",
        html_escaped(text.text));
}

std::string base64(std::string_view bytes) {
    static constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
        for (std::size_t k = 0; k < 3; ++k) {
            const auto byte = k < count ? static_cast<unsigned char>(bytes[at + k]) : 0u;
            group = group << 8u | byte;
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += k <= count ? digits[group >> (18 - 6 * k) & 63u] : '=';
        }
    }
    return text;
}

class HtmlWriter {
  public:
    std::string text;

    void operator()(const ReportHeading& heading) {
        text += fmt::format("<h{0}>{1}</h{0}>\n", heading.level, html_escaped(heading.text));
    }
    void operator()(const ReportParagraph& paragraph) {
        static constexpr std::array classes = {"", " class=\"lead\"", " class=\"note\""};
        text += fmt::format("<p{}>{}</p>\n",
                            classes[static_cast<std::size_t>(paragraph.role)],
                            html_escaped(paragraph.text));
    }
    void operator()(const ReportTable& table) {
        text += "<div class=\"scroll\"><table>\n<caption>" + html_escaped(table.caption) +
                "</caption>\n<thead><tr>";
        for (const ReportColumn& column : table.columns) {
            text += fmt::format("<th scope=\"col\"{}>{}</th>",
                                column.number ? " class=\"number\"" : "",
                                html_escaped(column.title));
        }
        text += "</tr></thead>\n<tbody>\n";
        for (const auto& row : table.rows) {
            text += "<tr>";
            for (std::size_t k = 0; k < row.size(); ++k) {
                text += fmt::format("<{0}{1}>{2}</{3}>",
                                    k == 0 ? "th scope=\"row\"" : "td",
                                    table.columns[k].number ? " class=\"number\"" : "",
                                    html_escaped(row[k]),
                                    k == 0 ? "th" : "td");
            }
            text += "</tr>\n";
        }
        text += "</tbody></table></div>\n";
        if (!table.note.empty()) (*this)(ReportParagraph{table.note, ParagraphRole::note});
    }
    void operator()(const ReportChart& chart) {
        const std::string id = fmt::format("chart-{}", ++charts_);
        (*this)(ReportHeading{3, chart.title});
        text += "<figure>" + svg_of(chart.drawing, chart.title, chart.alternative, id) +
                "<figcaption>" + html_escaped(chart.note) + "</figcaption></figure>\n";
    }
    void operator()(const ReportPictures& row) {
        text += "<div class=\"pictures\">\n";
        for (const ReportPicture& picture : row.pictures) {
            text += fmt::format(
                "<figure><img alt=\"{}\" width=\"{}\" height=\"{}\" "
                "src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
                html_escaped(picture.alternative),
                picture.pixels.width,
                picture.pixels.height,
                base64(png_bytes(picture.pixels)),
                html_escaped(picture.caption));
        }
        text += "</div>\n";
    }

  private:
    int charts_ = 0;
};

}  // namespace

std::string svg_of(const VectorDrawing& drawing,
                   const std::string& title,
                   const std::string& description,
                   const std::string& id) {
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" "
        "aria-labelledby=\"{}-title {}-text\" fill=\"none\" style=\"font-variant-numeric: "
        "tabular-nums\">\n<title id=\"{}-title\">{}</title>\n<desc id=\"{}-text\">{}</desc>\n",
        drawing.width,
        drawing.height,
        id,
        id,
        id,
        html_escaped(title),
        id,
        html_escaped(description));
    for (const auto& mark : drawing.marks) {
        svg += std::visit([](const auto& one) { return mark_of(one); }, mark);
    }
    return svg + "</svg>\n";
}

std::string html_of(const ReportDocument& document) {
    HtmlWriter writer;
    writer.text = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'\">\n<meta name=\"generator\" content=\"{0}\">\n"
        "<title>{1}</title>\n<style>{2}</style>\n</head>\n<body>\n<main>\n<header>\n"
        "<h1>{1}</h1>\n<p class=\"subtitle\">{3}</p>\n</header>\n",
        html_escaped(document.made_by),
        html_escaped(document.title),
        kStyle,
        html_escaped(document.subtitle));
    for (const ReportBlock& block : document.blocks) std::visit(writer, block);
    writer.text += fmt::format("<footer>{}, {}</footer>\n</main>\n</body>\n</html>\n",
                               html_escaped(document.made_by),
                               html_escaped(document.made_at));
    return writer.text;
}

PdfFile pdf_of(const ReportDocument& document) {
    // Built with this program and nothing else: plain C++ crosses the line.
    using Write = bool (*)(const ReportDocument&, const char* fonts, PdfFile&, std::string& why);
    static const auto write = reinterpret_cast<Write>(
        symbol_of_module("livery_pdf.so", "livery_write_pdf", "Livery's writer of PDF"));
    PdfFile file;
    std::string why;
    const auto fonts = shipped_path("fonts/Inter-Regular.otf").parent_path();
    if (!write(document, fonts.c_str(), file, why)) {
        throw FileError("PDF", "", why, "fonts, and a document that can be written");
    }
    return file;
}

namespace {

std::size_t code_points(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xc0) != 0x80; }));
}

}  // namespace

std::string text_of(const ReportTable& table) {
    std::vector<std::size_t> widths;
    for (const ReportColumn& column : table.columns) widths.push_back(code_points(column.title));
    for (const auto& row : table.rows) {
        for (std::size_t c = 0; c < row.size(); ++c) {
            widths[c] = std::max(widths[c], code_points(row[c]));
        }
    }
    const auto line = [&](const auto& cell_of) {
        std::string text;
        for (std::size_t c = 0; c < table.columns.size(); ++c) {
            const std::string& cell = cell_of(c);
            const std::string gap(widths[c] - code_points(cell), ' ');
            text += table.columns[c].number ? "  " + gap + cell : (c ? "  " : "") + cell + gap;
        }
        return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
    };
    std::string text = table.caption + "\n";
    text += line([&](std::size_t c) -> const std::string& { return table.columns[c].title; });
    for (const auto& row : table.rows) {
        text += line([&](std::size_t c) -> const std::string& { return row[c]; });
    }
    return table.note.empty() ? text : text + table.note + "\n";
}

}  // namespace livery
