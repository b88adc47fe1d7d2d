// livery evaluate report

#include <memory>

#include <fmt/format.h>

#include "cli/evaluate/commands.h"
#include "core/error.h"
#include "core/paths.h"
#include "core/system/version.h"
#include "core/time.h"
#include "core/utf8.h"
#include "evaluation/report/report_document.h"
#include "evaluation/report/round_report.h"
#include "jobs/calibrate/calibration_check.h"
#include "scene/colour_calibration.h"

namespace livery {

namespace {

namespace fs = std::filesystem;

struct ReportArguments {
    VoteSourceArguments source;
    std::string out, title, details, calibration;
};

/// A file of one of the two kinds, or both in a folder.
struct ReportPlaces {
    fs::path html, pdf;  ///< empty: not asked for
};

ReportPlaces places_of(const std::string& out, const std::string& stem) {
    const fs::path path = out;
    std::error_code error;
    const bool folder = fs::is_directory(path, error);
    if (!folder && path.extension() == ".html") return {path, {}};
    if (!folder && path.extension() == ".pdf") return {{}, path};
    check_argument(folder || !path.has_extension(),
                   "--out: found \"" + out + "\", expected a name in .html or .pdf, or a folder");
    make_output_folder(path);
    return {path / (stem + ".html"), path / (stem + ".pdf")};
}

std::string stem_of(const VoteSource& source, bool sample) {
    if (sample) return "sample-round";
    const auto& record = source.round.record;
    return record ? fmt::format("round-{}", record->round.id) : "vote";
}

/// What a calibration says of itself, of the round's own calibration.
std::vector<std::pair<std::string, std::string>> figures_of_calibration(const fs::path& folder,
                                                                        const std::string& id) {
    const fs::path file = folder / "calibration.json";
    const ColourCalibration c = parse_calibration(read_text_file(file), file);
    if (c.id != id) {
        throw FileError(file,
                        "id",
                        c.id,
                        id.empty() ? "none: the round was shown uncorrected"
                                   : id + ", under which the round was shown");
    }
    return calibration_figures(c);
}

/// With what stands beside the ballots.
RoundReportSource completed(const ReportArguments& arguments, VoteSource source) {
    RoundReportSource report = std::move(source.round);
    if (report.record) {
        const Round& round = report.record->round;
        // One that was asked for must be there; the one beside the ballots may be.
        report.details =
            arguments.details.empty()
                ? read_round_details(source.details, round.id, round.codes)
                : parse_round_details(
                      read_text_file(arguments.details), arguments.details, round.id, round.codes);
        if (!arguments.calibration.empty()) {
            report.calibration =
                figures_of_calibration(arguments.calibration, round.calibration_id);
        }
    }
    if (!arguments.title.empty()) report.details.title = printable(arguments.title, 200);
    report.program = "livery " + version_number();
    report.made_at = utc_now();
    return report;
}

void check_report_options(const ReportArguments& arguments) {
    const bool typed = arguments.source.ballots.empty() && !arguments.source.sample;
    for (const auto& [option, value] :
         {std::pair{"--details", &arguments.details}, {"--calibration", &arguments.calibration}}) {
        check_argument(!typed || value->empty(),
                       std::string(option) + ": found it with counts, expected a file of ballots");
    }
}

}  // namespace

Command evaluate_report_command() {
    const auto arguments = std::make_shared<ReportArguments>();
    Command command;
    command.name = "evaluate report";
    command.summary = "what a round of votes says, as a page to hand on and as PDF";
    command.example = "livery evaluate report --ballots votes.livery-ballots --out report";
    command.options = vote_source_options(arguments->source);
    command.options.insert(
        command.options.end(),
        {{"--out",
          "FILE|DIR",
          "a file in .html or .pdf, or a folder for both",
          &arguments->out,
          true},
         {"--title", "TEXT", "what stands above it (default: the round)", &arguments->title},
         {"--details",
          "FILE",
          "what was asked, how it was shown, pictures (default: round.json of the folder "
          "BALLOTS-round-N beside the ballots, where it is)",
          &arguments->details},
         {"--calibration",
          "DIR",
          "the round's calibration, for its figures",
          &arguments->calibration}});
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        check_report_options(*arguments);
        VoteSource source =
            read_vote_source(arguments->source, static_cast<std::uint64_t>(common.seed));
        progress.update(0.5, "writing the report");
        const std::string stem = stem_of(source, arguments->source.sample);
        const RoundReportSource report = completed(*arguments, std::move(source));
        Outcome outcome;
        outcome.figures = figures_of(report.statistics, report.names);
        if (report.record) outcome.figures["round"] = report.record->round.id;
        const auto duel = report.record ? report.record->duel : std::nullopt;
        if (duel) outcome.figures["series"] = figures_of(*duel);
        if (!report.scales.scales.empty()) outcome.figures["scales"] = figures_of(report.scales);
        if (arguments->source.sample) outcome.figures["sample"] = true;
        const ReportDocument document = round_report(report);
        const ReportPlaces places = places_of(arguments->out, stem);
        std::vector<std::string> notes;
        outcome.figures["files"] = Json::array();
        const auto written = [&](const fs::path& file, const std::string& bytes) {
            write_text_file(file, bytes);
            outcome.figures["files"].push_back(file.string());
            outcome.text += file.string() + "\n";
        };
        if (!places.html.empty()) written(places.html, html_of(document));
        if (!places.pdf.empty()) {
            const PdfFile pdf = pdf_of(document);
            written(places.pdf, pdf.bytes);
            outcome.figures["pdf_pages"] = pdf.pages;
            if (pdf.unknown_characters > 0) {
                notes.push_back(fmt::format(
                    "{} characters of the PDF stand as boxes, since no font at hand has them: "
                    "install one, such as Debian's fonts-noto",
                    pdf.unknown_characters));
            }
        }
        outcome.text += "verdict: " + outcome.figures["verdict"].get<std::string>() + "\n";
        if (duel) outcome.text += "duel: " + duel->words + "\n";
        if (arguments->source.sample) outcome.text += "A made-up sample: nobody voted.\n";
        tell_notes(notes, outcome);
        return outcome;
    };
    return command;
}

}  // namespace livery
