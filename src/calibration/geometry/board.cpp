#include "calibration/geometry/board.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

std::string name_of(const Board& board) {
    return fmt::format("{} {}x{}",
                       board.kind == BoardKind::charuco ? "charuco" : "chessboard",
                       board.columns,
                       board.rows);
}

void check_board(const Board& board) {
    check_argument(
        board.columns >= 3 && board.rows >= 3 && board.columns <= 100 && board.rows <= 100,
        fmt::format(
            "a board of {}x{} inner corners, expected 3x3 to 100x100", board.columns, board.rows));
    check_argument(
        std::isfinite(board.square_mm) && board.square_mm >= 1.0 && board.square_mm <= 1000.0,
        fmt::format("squares of {} mm (--square-mm), expected 1 to 1000", board.square_mm));
    if (board.kind != BoardKind::charuco) return;
    const double share = board.marker_mm / board.square_mm;
    check_argument(share >= 0.3 && share <= 0.9,
                   fmt::format("markers of {} mm (--marker-mm), expected 0.3 to 0.9 of a square, "
                               "{:.1f} to {:.1f}",
                               board.marker_mm,
                               0.3 * board.square_mm,
                               0.9 * board.square_mm));
    const int markers = (board.columns + 1) * (board.rows + 1) / 2;
    check_argument(markers <= kMarkers,
                   fmt::format("a ChArUco board of {}x{} inner corners has {} markers, expected at "
                               "most {}",
                               board.columns,
                               board.rows,
                               markers,
                               kMarkers));
}

std::vector<glm::dvec2> corners_mm(const Board& board) {
    std::vector<glm::dvec2> corners;
    for (int row = 0; row < board.rows; ++row)
        for (int column = 0; column < board.columns; ++column)
            corners.emplace_back(column * board.square_mm, row * board.square_mm);
    return corners;
}

MarkerCells marker_cells(int number) {
    check_argument(number >= 0 && number < kMarkers,
                   fmt::format("marker {}, expected 0 to {}", number, kMarkers - 1));
    constexpr std::array<const char*, 4> kWords = {"10000", "10111", "01001", "01110"};
    MarkerCells cells;
    for (std::size_t row = 0; row < 5; ++row) {
        const auto pair = static_cast<std::size_t>(number >> (8 - 2 * row)) & 3u;
        for (std::size_t column = 0; column < 5; ++column)
            cells[5 * row + column] = kWords[pair][column] == '1';
    }
    return cells;
}

std::vector<BoardMarker> markers_of(const Board& board) {
    std::vector<BoardMarker> markers;
    if (board.kind != BoardKind::charuco) return markers;
    for (int row = 0; row <= board.rows; ++row)
        for (int column = 0; column <= board.columns; ++column)
            if ((row + column) % 2 == 1)
                markers.push_back({static_cast<int>(markers.size()),
                                   board.square_mm * glm::dvec2(column - 0.5, row - 0.5)});
    return markers;
}

namespace {

constexpr double kUnprintable_mm = 8.0;  ///< what printers leave white at a page's border
constexpr double kFoot_mm = 18.0;        ///< the ruler, the words and what is not printed
constexpr double kLetters_mm = 2.8;
constexpr double kRuler_mm = 100.0;

/// Dark where `dark`, else white; from the page's upper left.
struct Bar {
    double left_mm, top_mm, width_mm, height_mm;
    bool dark;
};

struct PageText {
    double left_mm, base_mm;
    std::string text;
};

struct Page {
    double width_mm = 0.0, height_mm = 0.0;
    std::vector<Bar> board, ruler;
    std::vector<PageText> words;
};

double border_mm(double square_mm) { return std::max(kUnprintable_mm, 0.5 * square_mm); }

bool fits(const Board& board, double square_mm, double width_mm, double height_mm) {
    const double border = border_mm(square_mm);
    return (board.columns + 1) * square_mm + 2.0 * border <= width_mm &&
           (board.rows + 1) * square_mm + 2.0 * border + kFoot_mm <= height_mm &&
           kRuler_mm + 2.0 * kUnprintable_mm <= width_mm;
}

/// In steps of half a millimetre.
double largest_square_mm(const Board& board, double width_mm, double height_mm) {
    double square = 0.0;
    while (fits(board, square + 0.5, width_mm, height_mm)) square += 0.5;
    return square;
}

void draw_markers(const Board& board, double left_mm, double top_mm, Page& page) {
    const double side = board.marker_mm, cell = side / 7.0;
    for (const BoardMarker& marker : markers_of(board)) {
        const double left = left_mm + marker.middle_mm.x + board.square_mm - 0.5 * side;
        const double top = top_mm + marker.middle_mm.y + board.square_mm - 0.5 * side;
        page.board.push_back({left, top, side, side, true});
        const MarkerCells cells = marker_cells(marker.number);
        for (std::size_t row = 0; row < 5; ++row)
            for (std::size_t column = 0; column < 5; ++column) {
                // Cells side by side as one bar: a seam between two would be printed.
                std::size_t end = column;
                while (end < 5 && cells[5 * row + end]) ++end;
                if (end == column) continue;
                page.board.push_back({left + cell * static_cast<double>(column + 1),
                                      top + cell * static_cast<double>(row + 1),
                                      cell * static_cast<double>(end - column),
                                      cell,
                                      false});
                column = end;
            }
    }
}

void draw_ruler(double left_mm, double top_mm, Page& page) {
    constexpr double kLine = 0.25;
    page.ruler.push_back({left_mm, top_mm, kRuler_mm, kLine, true});
    for (int k = 0; k <= 10; ++k) {
        const double at = std::clamp(10.0 * k - 0.5 * kLine, 0.0, kRuler_mm - kLine);
        page.ruler.push_back({left_mm + at, top_mm, kLine, k % 5 == 0 ? 3.0 : 2.0, true});
    }
}

Page page_of(const Board& board, const PaperSize& paper) {
    check_board(board);
    Page page;
    page.width_mm = paper.width_mm;
    page.height_mm = paper.height_mm;
    if (board.columns > board.rows) std::swap(page.width_mm, page.height_mm);
    if (!fits(board, board.square_mm, page.width_mm, page.height_mm)) {
        const double largest = largest_square_mm(board, page.width_mm, page.height_mm);
        throw std::invalid_argument(fmt::format(
            "--square-mm: found {}, expected at most {} for {}x{} inner corners on {}, a white "
            "border and the ruler included",
            board.square_mm,
            largest,
            board.columns,
            board.rows,
            paper.name));
    }
    const double width = (board.columns + 1) * board.square_mm;
    const double height = (board.rows + 1) * board.square_mm;
    const double left = 0.5 * (page.width_mm - width);
    const double top = 0.5 * (page.height_mm - kFoot_mm - height);
    for (int row = 0; row <= board.rows; ++row)
        for (int column = 0; column <= board.columns; ++column)
            if ((row + column) % 2 == 0)
                page.board.push_back({left + column * board.square_mm,
                                      top + row * board.square_mm,
                                      board.square_mm,
                                      board.square_mm,
                                      true});
    if (board.kind == BoardKind::charuco) draw_markers(board, left, top, page);

    const double ruler_top = page.height_mm - kFoot_mm;
    draw_ruler(kUnprintable_mm, ruler_top, page);
    std::string sizes =
        fmt::format("Livery: {}, squares of {:g} mm",
                    board.kind == BoardKind::charuco ? "ChArUco board" : "chessboard",
                    board.square_mm);
    if (board.kind == BoardKind::charuco)
        sizes += fmt::format(", markers of {:g} mm (ArUco original)", board.marker_mm);
    page.words.push_back(
        {kUnprintable_mm,
         ruler_top + 6.0,
         fmt::format("The line is 100 mm: print at 100%, measure it. {}.", sizes)});
    std::string options = fmt::format("--board {}{}x{} --square-mm {:g}",
                                      board.kind == BoardKind::charuco ? "charuco:" : "",
                                      board.columns,
                                      board.rows,
                                      board.square_mm);
    if (board.kind == BoardKind::charuco)
        options += fmt::format(" --marker-mm {:g}", board.marker_mm);
    page.words.push_back(
        {kUnprintable_mm, ruler_top + 10.0, "Glue it to something flat and stiff. " + options});
    return page;
}

}  // namespace

PaperSize paper_of(std::string_view name) {
    std::string lower;
    for (const char c : name)
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    static const std::vector<PaperSize> sizes = {{"A4", 210, 297},
                                                 {"A3", 297, 420},
                                                 {"A2", 420, 594},
                                                 {"A1", 594, 841},
                                                 {"A0", 841, 1189},
                                                 {"letter", 215.9, 279.4},
                                                 {"legal", 215.9, 355.6},
                                                 {"tabloid", 279.4, 431.8}};
    std::string known;
    for (const PaperSize& one : sizes) {
        std::string own;
        for (const char c : one.name)
            own += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (own == lower) return one;
        known += (known.empty() ? "" : ", ") + one.name;
    }
    throw std::invalid_argument(
        fmt::format("--paper: found \"{}\", expected one of {}", name, known));
}

std::string board_svg(const Board& board, const PaperSize& paper) {
    const Page page = page_of(board, paper);
    const int ink = static_cast<int>(std::lround(255.0 * kBoardInk));
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}mm\" height=\"{1:g}mm\" "
        "viewBox=\"0 0 {0:g} {1:g}\">\n<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#fff\"/>\n",
        page.width_mm,
        page.height_mm);
    const auto add = [&](const std::vector<Bar>& bars, const std::string& dark) {
        for (const Bar& bar : bars)
            text += fmt::format(
                "<rect x=\"{:.4f}\" y=\"{:.4f}\" width=\"{:.4f}\" height=\"{:.4f}\" "
                "fill=\"{}\"/>\n",
                bar.left_mm,
                bar.top_mm,
                bar.width_mm,
                bar.height_mm,
                bar.dark ? dark : "#fff");
    };
    add(page.board, fmt::format("#{0:02x}{0:02x}{0:02x}", ink));
    add(page.ruler, "#000");
    for (const PageText& words : page.words)
        text += fmt::format(
            "<text x=\"{:.4f}\" y=\"{:.4f}\" font-family=\"sans-serif\" font-size=\"{:g}\">{}"
            "</text>\n",
            words.left_mm,
            words.base_mm,
            kLetters_mm,
            words.text);
    return text + "</svg>\n";
}

std::string board_pdf(const Board& board, const PaperSize& paper) {
    const Page page = page_of(board, paper);
    constexpr double kPointsPerMm = 72.0 / 25.4;
    // Millimetres from the lower left from here on.
    std::string content = fmt::format("{0:.8f} 0 0 {0:.8f} 0 0 cm\n", kPointsPerMm);
    const auto add = [&](const std::vector<Bar>& bars, double dark) {
        for (const Bar& bar : bars)
            content += fmt::format("{:g} g {:.4f} {:.4f} {:.4f} {:.4f} re f\n",
                                   bar.dark ? dark : 1.0,
                                   bar.left_mm,
                                   page.height_mm - bar.top_mm - bar.height_mm,
                                   bar.width_mm,
                                   bar.height_mm);
    };
    add(page.board, kBoardInk);
    add(page.ruler, 0.0);
    for (const PageText& words : page.words) {
        std::string escaped;
        for (const char c : words.text) {
            if (c == '(' || c == ')' || c == '\\') escaped += '\\';
            escaped += c;
        }
        content += fmt::format("0 g BT /F1 {:g} Tf {:.4f} {:.4f} Td ({}) Tj ET\n",
                               kLetters_mm,
                               words.left_mm,
                               page.height_mm - words.base_mm,
                               escaped);
    }
    const std::vector<std::string> objects = {
        "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.4f} {:.4f}] /Contents 4 0 R "
                    "/Resources << /Font << /F1 5 0 R >> >> >>",
                    page.width_mm * kPointsPerMm,
                    page.height_mm * kPointsPerMm),
        fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content),
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>"};
    std::string text = "%PDF-1.4\n";
    std::string table = fmt::format("xref\n0 {}\n0000000000 65535 f \n", objects.size() + 1);
    for (std::size_t k = 0; k < objects.size(); ++k) {
        table += fmt::format("{:010} 00000 n \n", text.size());
        text += fmt::format("{} 0 obj\n{}\nendobj\n", k + 1, objects[k]);
    }
    return text + fmt::format("{}trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n",
                              table,
                              objects.size() + 1,
                              text.size());
}

}  // namespace livery
