// livery board
// livery calibrate geometry
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "calibration/geometry/board.h"
#include "cli/capture_options.h"
#include "cli/command.h"
#include "core/error.h"
#include "core/paths.h"
#include "jobs/pair_geometry.h"

namespace livery {

namespace {

struct BoardArguments {
    std::string board;
    double square_mm = 0.0;
    double marker_mm = 0.0;  ///< 0: seven tenths of a square
};

constexpr double kMarkerShare = 0.7;
constexpr const char* kCharuco = "charuco:";

/// --board, --square-mm, --marker-mm.
std::vector<Option> board_options(BoardArguments& arguments, bool required) {
    return {{"--board",
             "[charuco:]WxH",
             "inner corners of a chessboard or a ChArUco board",
             &arguments.board,
             required,
             {}},
            {"--square-mm", "MM", "side of a square", &arguments.square_mm, required, {}},
            {"--marker-mm",
             "MM",
             "side of a ChArUco board's markers (default: 0.7 of a square)",
             &arguments.marker_mm}};
}

/// "9x7" or "charuco:9x7": columns and rows of inner corners. Throws std::invalid_argument.
Board parse_board(const BoardArguments& arguments) {
    Board board;
    std::string size = arguments.board;
    if (size.starts_with(kCharuco)) {
        board.kind = BoardKind::charuco;
        size.erase(0, std::string(kCharuco).size());
    }
    char end = 0;
    const bool whole =
        std::sscanf(size.c_str(), "%3dx%3d%c", &board.columns, &board.rows, &end) == 2;
    if (!whole || board.columns < 3 || board.rows < 3 || board.columns > 100 || board.rows > 100)
        throw std::invalid_argument(
            fmt::format("--board: found \"{}\", expected COLUMNSxROWS of inner corners, 3 to 100 "
                        "each, or charuco:COLUMNSxROWS",
                        arguments.board));
    board.square_mm = arguments.square_mm;
    check_argument(std::isfinite(board.square_mm) && board.square_mm > 0.0,
                   fmt::format("--square-mm: found {}, expected more than 0", board.square_mm));
    check_argument(std::isfinite(arguments.marker_mm) && arguments.marker_mm >= 0.0 &&
                       (arguments.marker_mm == 0.0 || board.kind == BoardKind::charuco),
                   fmt::format("--marker-mm: found {}, expected more than 0, and a board of "
                               "charuco:COLUMNSxROWS",
                               arguments.marker_mm));
    if (board.kind == BoardKind::charuco)
        board.marker_mm =
            arguments.marker_mm > 0.0 ? arguments.marker_mm : kMarkerShare * board.square_mm;
    check_board(board);
    return board;
}

}  // namespace

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
    command.options.push_back(
        {"--paper", "SIZE", "A0 to A4, letter, legal or tabloid (default A4)", &arguments->paper});
    command.options.push_back({"--out", "FILE", "a .pdf or .svg file", &arguments->out, true});
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

namespace {

std::string text_of(const PairGeometry& geometry, const std::string& out) {
    const auto lens = [](const char* whose, const View& view, double error_px) {
        std::string text = fmt::format("{}: focal length {:.1f}", whose, view.focal_px.x);
        if (error_px > 0.0) text += fmt::format(" +- {:.1f}", error_px);
        return text + fmt::format(" px, principal point {:.1f}, {:.1f}\n",
                                  view.principal_px.x - 0.5,
                                  view.principal_px.y - 0.5);
    };
    std::string text;
    std::size_t used = 0;
    for (const BoardPose& pose : geometry.poses) {
        used += pose.used;
        text += pose.used ? fmt::format("{}: {} corners, foretold to {:.2f} px\n",
                                        pose.folder,
                                        pose.corners,
                                        pose.rms_px)
                          : fmt::format("{}: not used: {}\n", pose.folder, pose.reason);
    }
    if (geometry.from_boards)
        text += fmt::format(
            "{} of {} poses; a pose left out is foretold to {:.2f} px, what was fitted lies within "
            "{:.2f} px in the camera and {:.2f} px in the projector\n",
            used,
            geometry.poses.size(),
            geometry.held_out_rms_px,
            geometry.camera_rms_px,
            geometry.projector_rms_px);
    else
        text += fmt::format(
            "lenses as the data sheets have them; the rays of camera and projector pass each other "
            "by {:.2f} px in the median; registration corrects the lenses by the mock-up's mesh\n",
            geometry.stereo_rms_px);
    for (const std::string& warning : geometry.warnings) text += "warning: " + warning + "\n";
    text += lens("camera", geometry.camera, geometry.camera_standard_error_px[0]);
    text += lens("projector", geometry.projector, geometry.projector_standard_error_px[0]);
    return text + fmt::format(
                      "the lenses are {:.1f} mm apart: a tape tells whether that is so\nwrote {}\n",
                      glm::length(inverse(geometry.projector.view_from_world).translation),
                      out);
}

}  // namespace

Command calibrate_geometry_command() {
    struct Arguments {
        std::vector<std::string> captures;
        std::string projector, out, patterns;
        BoardArguments board;
        double white_threshold = -1.0, black_threshold = -1.0;
        DataSheets sheets{0.0, 0.5, 0.0, 0.0, 0.0};
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "calibrate geometry";
    command.summary =
        "Gray code photographs of a board, or of anything and data sheets -> camera, projector and "
        "how they stand";
    command.example =
        "livery calibrate geometry --captures pose-0 pose-1 pose-2 pose-3 --projector 1024x768 "
        "--board 9x7 --square-mm 75 --out geometry";
    command.options = {
        {"--captures",
         "DIR...",
         "Gray code photographs, a folder a pose of the board; without a board one folder",
         &arguments->captures,
         true},
        {"--projector", "WxH", "its resolution", &arguments->projector, true},
        patterns_option(arguments->patterns),
        {"--white-threshold",
         "N",
         "least difference of stripes and their inverse, file units (default: none)",
         &arguments->white_threshold},
        {"--black-threshold",
         "N",
         "least difference of white and black, file units (default: from the noise)",
         &arguments->black_threshold},
        {"--out", "DIR", "geometry.json, camera.json, projector.json", &arguments->out, true},
    };
    add_data_sheet_options(command.options, arguments->sheets);
    const std::vector<Option> board = board_options(arguments->board, false);
    command.options.insert(command.options.begin() + 2, board.begin(), board.end());
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        PairGeometryRequest request;
        request.captures = {arguments->captures.begin(), arguments->captures.end()};
        request.patterns_manifest = arguments->patterns;
        request.projector_px = parse_size("--projector", arguments->projector);
        request.black_threshold = arguments->black_threshold;
        request.white_threshold = arguments->white_threshold;
        if (!arguments->board.board.empty()) {
            request.board = parse_board(arguments->board);
            request.lens_distance_mm = arguments->sheets.lens_distance_mm;
        } else {
            check_whole(arguments->sheets,
                        " (or --board and --square-mm: photographs alone leave focal lengths and "
                        "sizes open)");
            request.data_sheets = arguments->sheets;
        }
        Outcome outcome;
        try {
            const PairGeometry geometry = find_pair_geometry(request, progress);
            write_pair_geometry(arguments->out, geometry);
            outcome.figures = figures_of(geometry);
            outcome.text = text_of(geometry, arguments->out);
        } catch (const Refused& refused) {
            outcome.figures = {{"poses", Json::array()}};
            report_refusal(refused, outcome);
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
