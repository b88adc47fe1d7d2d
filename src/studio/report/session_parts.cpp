#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/image_io.h"
#include "core/paths.h"
#include "core/pictures/png_bytes.h"
#include "core/utf8.h"
#include "evaluation/ballots.h"
#include "evaluation/closed_round.h"
#include "jobs/calibrate/calibration_check.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/file_check.h"
#include "scene/colour_calibration.h"
#include "studio/report/problem_report.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

// What mail takes is less, but whoever asks for pictures may have another way.
constexpr std::size_t kLargestPicture_bytes = 32u << 20u, kMostPictures_bytes = 128u << 20u;
constexpr std::uint64_t kOrderOfBallots = 1;  // the seed of `livery evaluate export`

/// A section that fails says why and lets the next one follow.
std::string section(const std::string& title, const std::function<std::string()>& write) {
    try {
        return title + "\n" + write() + "\n";
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        return title + "\nNot found out: " + error.what() + "\n\n";
    }
}

std::string figures_text(const Path& folder) {
    const Path file = folder / "calibration.json";
    const ColourCalibration calibration = parse_calibration(read_text_file(file), file);
    std::string text = fmt::format(
        "Id: {}\nProjector: {}x{}\n", calibration.id, calibration.width, calibration.height);
    for (const auto& [name, value] : calibration_figures(calibration)) {
        text += name + ": " + value + "\n";
    }
    for (const GradedFigure& figure : grade_figures(calibration)) {
        if (figure.scale.empty()) continue;  // it is above already
        text += fmt::format(
            "{}: {}, {} ({})\n", to_string(figure.grade), figure.name, figure.value, figure.scale);
    }
    return text;
}

std::string origin_text(const Path& folder) {
    const auto origin = read_origin(folder, false);
    if (!origin) return "The folder does not say.\n";
    return fmt::format(
        "Product: {}\nWith: {}\nPose: {}\nCapture: {:.0f} s, solved in {:.0f} s\nReposed from: "
        "{}\n",
        origin->product,
        origin->made_with,
        origin->room ? "found in the room" : "given",
        origin->capture_seconds,
        origin->solve_seconds,
        origin->reposed_from.empty() ? "none" : origin->reposed_from);
}

std::vector<Path> files_in(const Path& folder) {
    std::vector<Path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string sizes_text(const Path& folder) {
    std::string text;
    for (const Path& file : files_in(folder)) {
        text += fmt::format(
            "{}, {} bytes\n", file.filename().string(), std::filesystem::file_size(file));
    }
    return text;
}

std::string check_text(const Path& folder, const Progress& progress) {
    const FileCheck check = check_file(folder, progress);
    std::string text;
    for (const std::string& problem : check.problems) text += problem + "\n";
    return text.empty() ? "Nothing.\n" : text;
}

/// Pictures until there are enough of them.
struct PictureList {
    std::vector<ReportFile> files;
    std::size_t bytes = 0;

    /// Two files of one name in different folders are told apart by a number. An archive takes no
    /// backslashes, and texts alone.
    std::string free_name(const std::string& folder, const Path& picture) const {
        std::string own = printable(picture.filename().string());
        std::replace(own.begin(), own.end(), '\\', '_');
        std::string name = "pictures/" + folder + "/" + own;
        const auto taken = [&](const ReportFile& file) {
            return file.name == name || file.name == name + ".txt";
        };
        for (int number = 2; std::any_of(files.begin(), files.end(), taken); ++number) {
            name = fmt::format("pictures/{}/{}-{}", folder, number, own);
        }
        return name;
    }

    void add(const std::string& folder, const Path& picture, const std::string& what) {
        ReportFile file{free_name(folder, picture), what, "", "", false};
        try {
            const std::size_t room = kMostPictures_bytes - std::min(bytes, kMostPictures_bytes);
            file.bytes = read_text_file(picture, std::min(kLargestPicture_bytes, room));
            bytes += file.bytes.size();
        } catch (const FileError& error) {
            file.problem = error.what();
            file.bytes = "Left out: " + file.problem + "\n";
            file.name += ".txt";
            file.is_text = true;
        }
        files.push_back(std::move(file));
    }
};

}  // namespace

std::string calibration_part(const Document* document, const Progress& progress) {
    if (!document) return "There is no session yet, and so no calibration.\n";
    const Path folder = document->calibration;
    if (folder.empty()) {
        return "The session has no calibration: its picture goes out uncorrected.\n";
    }
    return section("Folder", [&] { return folder.string() + "\n"; }) +
           section("Figures", [&] { return figures_text(folder); }) +
           section("Origin", [&] { return origin_text(folder); }) +
           section("Projector's view (projector.json)",
                   [&] { return read_text_file(folder / "projector.json"); }) +
           section("Files", [&] { return sizes_text(folder); }) +
           section("What is wrong with it", [&] { return check_text(folder, progress); });
}

std::vector<ReportFile> picture_parts(const Document* document,
                                      bool with_artwork,
                                      const Progress& progress) {
    PictureList list;
    if (!document) return {};
    if (!document->calibration.empty()) {
        try {
            for (const Path& file : files_in(document->calibration)) {
                progress.check_stop();
                if (has_picture_suffix(file)) list.add("calibration", file, "Of the calibration.");
            }
        } catch (const std::filesystem::filesystem_error& error) {
            const std::string why = error.what();
            list.files.push_back({"pictures/calibration.txt",
                                  "The calibration's pictures.",
                                  "Not found out: " + why + "\n",
                                  why,
                                  true});
        }
    }
    for (const SessionLook& look : document->looks) {
        if (!with_artwork) break;
        for (const Artwork& artwork : look.look.artwork) {
            progress.check_stop();
            if (artwork.picture.empty()) continue;
            Path picture = artwork.picture;
            try {
                picture = find_artwork_picture(artwork.picture, {});
            } catch (const FileError&) {
                // Reading it by its name says what is wrong.
            }
            list.add("artwork", picture, "Artwork of the look " + look.look.name + ".");
        }
    }
    return std::move(list.files);
}

ReportFile sent_picture_part(const Image8& drive) {
    return {"pictures/projector.png",
            "What the projector is sent now, device values.",
            png_bytes(drive),
            "",
            false};
}

std::vector<ReportFile> vote_parts(const Path& user_folder) {
    std::vector<ReportFile> files;
    const auto add = [&](const std::string& name, const std::string& what, const auto& write) {
        ReportFile file{name, what, "", "", true};
        try {
            file.bytes = write();
        } catch (const std::exception& error) {
            file.problem = error.what();
            file.bytes = "Not found out: " + file.problem + "\n";
        }
        files.push_back(std::move(file));
    };
    const Path ballots = user_folder / "ballots.sqlite";
    std::vector<int> closed;
    add("votes/rounds.txt", "Rounds of votes, without what anybody chose.", [&] {
        std::error_code error;
        // Opening a store would make the file.
        if (!std::filesystem::exists(ballots, error))
            return std::string("There was no vote yet.\n");
        std::string text;
        for (const Round& round : BallotStore(ballots).rounds()) {
            text += fmt::format("Round {}, {}: {} designs, {} ballots, {}\n",
                                round.id,
                                round.created,
                                round.designs.size(),
                                round.ballots,
                                round.closed() ? "closed" : "open");
            if (round.closed() && round.voting()) closed.push_back(round.id);
        }
        return text;
    });
    for (const int id : closed) {
        add(fmt::format("votes/round-{}.csv", id),
            "Ballots of a closed round, without names, in an order of chance.",
            [&] {
                return ballots_csv(read_closed_round(ballots, id, kOrderOfBallots),
                                   kOrderOfBallots);
            });
    }
    return files;
}

}  // namespace livery
