// livery board

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "calibration/geometry/board_drawing.h"
#include "cli/board_options.h"
#include "cli/command.h"
#include "core/paths.h"

namespace livery {

Command board_command() {
    struct Arguments {
        BoardArguments board;
        std::string paper = "A4", out;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "board";
    command.summary = "draw a board to print, in true size, for calibrate geometry";
    command.example = "livery board --board charuco:9x7 --square-mm 20 --out board.pdf";
    command.options = board_options(arguments->board, true);
    command.options.push_back({"--paper",
                               "SIZE",
                               "A0 to A4, letter, legal or tabloid (default A4)",
                               &arguments->paper,
                               false,
                               {}});
    command.options.push_back({"--out", "FILE", "a .pdf or .svg file", &arguments->out, true, {}});
    command.run = [arguments](const CommonOptions&, const Progress&) {
        const Board board = parse_board(arguments->board);
        const PaperSize paper = paper_of(arguments->paper);
        const std::filesystem::path file = arguments->out;
        const std::string suffix = file.extension().string();
        if (suffix != ".pdf" && suffix != ".svg")
            throw std::invalid_argument(fmt::format(
                "--out: found \"{}\", expected a name that ends in .pdf or .svg", file.string()));
        write_text_file(file, suffix == ".pdf" ? board_pdf(board, paper) : board_svg(board, paper));
        Outcome outcome;
        outcome.figures = {{"file", file.string()},
                           {"board", name_of(board)},
                           {"square_mm", board.square_mm},
                           {"marker_mm", board.marker_mm},
                           {"markers", markers_of(board).size()},
                           {"paper", paper.name}};
        outcome.text = fmt::format(
            "{} on {}, squares of {} mm, in {}: print it at 100% and measure the line of 100 mm\n",
            name_of(board),
            paper.name,
            board.square_mm,
            file.string());
        return outcome;
    };
    return command;
}

}  // namespace livery
