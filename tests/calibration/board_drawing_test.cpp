// Boards to print: what is drawn lies where the board has it, in millimetres, in both kinds of
// file, and the shipped files are what the program draws.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/geometry/board.h"
#include "calibration/support/board_photographs.h"
#include "calibration/support/messages.h"
#include "core/paths.h"

namespace livery {
namespace {

using testing::charuco_board;
using testing::chessboard;

/// From the page's upper left, millimetres; later ones cover earlier ones.
struct Bar {
    double left, top, width, height, grey;
};

std::vector<Bar> bars_of_svg(const std::string& svg) {
    static const std::regex rectangle(
        "<rect x=\"([^\"]+)\" y=\"([^\"]+)\" width=\"([^\"]+)\" height=\"([^\"]+)\" "
        "fill=\"#([0-9a-f]+)\"");
    std::vector<Bar> bars;
    for (std::sregex_iterator one(svg.begin(), svg.end(), rectangle), end; one != end; ++one) {
        const std::string digits = (*one)[5].str().substr(0, 2);
        bars.push_back({std::stod((*one)[1]),
                        std::stod((*one)[2]),
                        std::stod((*one)[3]),
                        std::stod((*one)[4]),
                        std::stoi(digits, nullptr, 16) / 255.0});
    }
    return bars;
}

std::vector<Bar> bars_of_pdf(const std::string& pdf, double page_height_mm) {
    static const std::regex rectangle("([0-9.]+) g ([0-9.]+) ([0-9.]+) ([0-9.]+) ([0-9.]+) re f");
    std::vector<Bar> bars;
    for (std::sregex_iterator one(pdf.begin(), pdf.end(), rectangle), end; one != end; ++one) {
        const double height = std::stod((*one)[5]);
        bars.push_back({std::stod((*one)[2]),
                        page_height_mm - std::stod((*one)[3]) - height,
                        std::stod((*one)[4]),
                        height,
                        std::stod((*one)[1])});
    }
    return bars;
}

double grey_at(const std::vector<Bar>& bars, double x, double y) {
    double grey = 1.0;
    for (const Bar& bar : bars)
        if (x >= bar.left && y >= bar.top && x < bar.left + bar.width && y < bar.top + bar.height)
            grey = bar.grey;
    return grey;
}

/// Every place of the board is as dark as the board has it; on the page it lies in the middle.
void expect_board(const std::vector<Bar>& bars, const Board& board, double page_width_mm) {
    const double width = (board.columns + 1) * board.square_mm;
    const double height = (board.rows + 1) * board.square_mm;
    ASSERT_FALSE(bars.empty());
    EXPECT_NEAR(bars.front().left, 0.5 * (page_width_mm - width), 1e-3);
    const auto reflectance = board.kind == BoardKind::charuco
                                 ? charuco_board(board)
                                 : chessboard(board.columns, board.rows, board.square_mm);
    int wrong = 0;
    // Steps that meet no edge of squares or cells.
    for (double y = -2.03; y < height + 2.0; y += 0.713)
        for (double x = -2.03; x < width + 2.0; x += 0.717) {
            const bool dark = reflectance({x - board.square_mm, y - board.square_mm}) < 0.5;
            const double grey = grey_at(bars, bars.front().left + x, bars.front().top + y);
            wrong += dark != (grey < 0.9);
            if (dark) {
                EXPECT_NEAR(grey, kBoardInk, 0.003);
            }
        }
    EXPECT_EQ(wrong, 0);
}

TEST(BoardDrawing, TheBoardIsDrawnInTrueSizeInBothKindsOfFile) {
    struct Case {
        Board board;
        const char* paper;
        double width_mm, height_mm;
    };
    for (const Case& one : {Case{{9, 7, 20.0}, "A4", 297, 210},
                            Case{{9, 7, 20.0, BoardKind::charuco, 14.0}, "a4", 297, 210},
                            Case{{4, 6, 25.0, BoardKind::charuco, 17.5}, "A4", 210, 297},
                            Case{{6, 5, 24.0, BoardKind::charuco, 16.8}, "Letter", 279.4, 215.9}}) {
        const PaperSize paper = paper_of(one.paper);
        const std::string svg = board_svg(one.board, paper);
        char size[80];
        std::snprintf(
            size, sizeof(size), "width=\"%gmm\" height=\"%gmm\"", one.width_mm, one.height_mm);
        EXPECT_NE(svg.find(size), std::string::npos) << svg.substr(0, 200);
        expect_board(bars_of_svg(svg), one.board, one.width_mm);

        const std::string pdf = board_pdf(one.board, paper);
        const double points = 72.0 / 25.4;
        std::snprintf(size,
                      sizeof(size),
                      "/MediaBox [0 0 %.4f %.4f]",
                      one.width_mm * points,
                      one.height_mm * points);
        EXPECT_NE(pdf.find(size), std::string::npos);
        std::snprintf(size, sizeof(size), "%.8f 0 0 %.8f 0 0 cm", points, points);
        EXPECT_NE(pdf.find(size), std::string::npos);
        expect_board(bars_of_pdf(pdf, one.height_mm), one.board, one.width_mm);
    }
}

TEST(BoardDrawing, TheRulerIsAHundredMillimetresLong) {
    const Board board{9, 7, 20.0};
    const auto bars = bars_of_svg(board_svg(board, paper_of("A4")));
    double longest = 0.0;
    for (const Bar& bar : bars)
        if (bar.grey == 0.0) longest = std::max(longest, bar.width);
    EXPECT_DOUBLE_EQ(longest, 100.0);
    EXPECT_NE(board_pdf(board, paper_of("A4")).find("The line is 100 mm: print at 100%"),
              std::string::npos);
}

// Each object stands where the table of a PDF says.
TEST(BoardDrawing, ThePdfsTableIsTrue) {
    const std::string pdf = board_pdf({9, 7, 20.0, BoardKind::charuco, 14.0}, paper_of("A4"));
    EXPECT_TRUE(pdf.starts_with("%PDF-1.4\n"));
    const std::size_t table = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
    ASSERT_EQ(pdf.substr(table, 5), "xref\n");
    for (int k = 1; k <= 5; ++k) {
        const std::size_t line = table + std::string("xref\n0 6\n").size() + 20u * std::size_t(k);
        const std::size_t place = std::stoul(pdf.substr(line, 10));
        EXPECT_EQ(pdf.substr(place, 8), std::to_string(k) + " 0 obj\n");
    }
    const std::size_t length = std::stoul(pdf.substr(pdf.find("/Length ") + 8));
    const std::size_t begin = pdf.find("stream\n") + 7;
    EXPECT_EQ(pdf.substr(begin + length, 9), "endstream");
}

TEST(BoardDrawing, WhatDoesNotFitSaysWhatDoes) {
    const std::string message = message_of<std::invalid_argument>([] {
        board_pdf({9, 7, 25.0}, paper_of("A4"));
    });
    EXPECT_NE(message.find("--square-mm: found 25, expected at most 21 for"), std::string::npos)
        << message;
    EXPECT_NO_THROW(board_pdf({9, 7, 21.0}, paper_of("A4")));
    EXPECT_THROW(paper_of("A9"), std::invalid_argument);
    EXPECT_NE(message_of<std::invalid_argument>([] { paper_of("poster"); }).find("A4, A3"),
              std::string::npos);
}

TEST(BoardDrawing, ShippedFilesAreWhatTheProgramDraws) {
    struct Case {
        const char* file;
        Board board;
        const char* paper;
    };
    for (const Case& one :
         {Case{"chessboard-9x7-20mm-a4.pdf", {9, 7, 20.0}, "A4"},
          Case{"charuco-9x7-20mm-a4.pdf", {9, 7, 20.0, BoardKind::charuco, 14.0}, "A4"},
          Case{"chessboard-9x7-30mm-a3.pdf", {9, 7, 30.0}, "A3"},
          Case{"charuco-9x7-30mm-a3.pdf", {9, 7, 30.0, BoardKind::charuco, 21.0}, "A3"}}) {
        const std::string shipped =
            read_text_file(shipped_path(std::string("calibration/boards/") + one.file));
        EXPECT_EQ(shipped, board_pdf(one.board, paper_of(one.paper)))
            << one.file << ": write it anew with livery board";
    }
}

}  // namespace
}  // namespace livery
