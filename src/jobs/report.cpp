#include "jobs/report.h"

#include <fmt/format.h>

#include "core/paths.h"
#include "core/text/markup.h"

namespace livery {

namespace {

/// Where the pose came from.
std::string pose_note(const DemoResult& result) {
    if (!result.room) return "pose and lens are read from the bench file";
    return fmt::format(
        "found from photographs, data sheets and a tape; {} of {} pixels looked at agree with the "
        "mesh to {:.2f} projector pixels (root mean square)",
        result.room->geometry.inliers,
        result.room->geometry.correspondences,
        result.room->geometry.rms_px);
}

std::string off_note(const DemoResult& result) {
    return fmt::format("{:.2f} / {:.2f} projector pixels",
                       result.picture_off_px.median,
                       result.picture_off_px.p95);
}

/// The paper's Table 3: ten evaluators, designs a to d.
constexpr int kPaperBest[] = {1, 6, 1, 2};
constexpr int kPaperSecond[] = {0, 3, 2, 5};

Json figures_of(const ErrorStatistics& statistics) {
    if (statistics.pixels == 0) {
        return {{"pixels", 0}, {"median", nullptr}, {"p95", nullptr}, {"mean", nullptr}};
    }
    return {{"pixels", statistics.pixels},
            {"median", statistics.median},
            {"p95", statistics.p95},
            {"mean", statistics.mean},
            {"worst", statistics.worst}};
}

std::string percent(double fraction) { return fmt::format("{:.1f}%", 100.0 * fraction); }

std::string cell(const ErrorStatistics& statistics) {
    if (statistics.pixels == 0) return "<td>none</td>";
    return fmt::format("<td>{:.2f} / {:.2f}</td>", statistics.median, statistics.p95);
}

/// "Good", "Usable" or "Bad" against a stated scale, with the reason.
std::string verdict(const DesignResult& design) {
    const ErrorStatistics& s = design.seen.corrected.interior;
    if (s.pixels == 0) return "Bad: no pixel of this look can be shown";
    if (design.seen.corrected.valid_fraction < 0.95)
        return "Bad: over 5% of the reachable pixels are masked";
    if (s.median <= 0.5 && s.p95 <= 1.5)
        return "Good: median at most 0.5, 95th percentile at most 1.5";
    if (s.median <= 1.0 && s.p95 <= 2.5)
        return "Usable: median at most 1.0, 95th percentile at most 2.5";
    return "Bad: median over 1.0 or 95th percentile over 2.5";
}

std::string figure(const DesignResult& design,
                   const std::string& what,
                   const std::string& caption) {
    const auto picture = design.pictures.find(what);
    if (picture == design.pictures.end()) return "";
    return fmt::format(
        "<figure><img src=\"{}\" alt=\"{}, {}\"><figcaption>{}</figcaption></figure>\n",
        html_escaped(picture->second.string()),
        html_escaped(design.name),
        html_escaped(caption),
        html_escaped(caption));
}

std::string design_section(const DesignResult& design) {
    std::string html =
        fmt::format("<section><h2>{}</h2>\n<p class=\"verdict\">{}</p>\n<div class=\"row\">\n",
                    html_escaped(design.name),
                    html_escaped(verdict(design)));
    html += figure(design, "sample", "Painted sample");
    html += figure(design, "wanted", "Wanted");
    html += figure(design, "uncorrected", "Uncorrected");
    html += figure(design, "corrected", "Corrected");
    html += figure(design, "difference", "CIEDE2000, 0 to 5");
    html += "</div>\n<div class=\"row\">\n";
    html += figure(design, "photograph-uncorrected", "Photograph, uncorrected");
    html += figure(design, "photograph-corrected", "Photograph, corrected");
    html += "</div></section>\n";
    return html;
}

std::string design_table(const DemoResult& result) {
    std::string html =
        "<table><caption>CIEDE2000, median / 95th percentile, by the bench's spectral observer in "
        "the eye's picture of the mock-up: what the light does where it falls, pose and lens "
        "included. The last column compares each projector pixel by itself with what was drawn for "
        "it.</caption><tr><th>Look</th><th>Corrected</th><th>2 px edge band</th>"
        "<th>Out of reach (clipped)</th><th>Uncorrected</th><th>Chart-only camera matrix</th>"
        "<th>In reach</th><th>Valid of these</th><th>Predicted pixels alone</th><th>Predicted</th>"
        "<th>Masked</th><th>Unlit</th><th>At projector pixels</th></tr>\n";
    for (const DesignResult& design : result.designs) {
        html += fmt::format(
            "<tr><th>{}</th>{}{}{}{}{}<td>{}</td><td>{}</td>{}<td>{}</td><td>{}</td><td>{}</td>{}</"
            "tr>"
            "\n",
            html_escaped(design.name),
            cell(design.seen.corrected.interior),
            cell(design.seen.corrected.edge),
            cell(design.seen.corrected.clipped),
            cell(design.seen.uncorrected.interior),
            design.seen.chart_corrected ? cell(design.seen.chart_corrected->interior)
                                        : "<td>not run</td>",
            percent(design.seen.corrected.reachable_fraction),
            percent(design.seen.corrected.valid_fraction),
            cell(design.seen.corrected.predicted),
            percent(design.seen.corrected.predicted_fraction),
            percent(design.seen.corrected.masked_fraction),
            percent(design.unlit_fraction),
            cell(design.pixels.corrected.interior));
    }
    return html + "</table>\n";
}

std::string calibration_section(const DemoResult& result) {
    const ColourCalibration& c = result.calibration;
    std::string html = "<section><h2>Calibration</h2><table>\n";
    const auto row = [&](const std::string& name, const std::string& value) {
        html += fmt::format(
            "<tr><th>{}</th><td>{}</td></tr>\n", html_escaped(name), html_escaped(value));
    };
    row("Id", c.id);
    row("Made with", c.made_with + ", " + c.created);
    row("Mode",
        c.mode + (c.table.grid > 0 ? ", table for a projector that is not additive"
                                   : ", additive model"));
    row("Camera to XYZ", c.xyz_origin);
    row("Additivity error", percent(c.additivity_error));
    row("Condition of the mixing, 99th percentile", fmt::format("{:.2f}", c.condition_p99));
    row("Measured, of the lit pixels", percent(c.valid_fraction));
    row("Predicted from the pose, of the valid pixels", percent(c.predicted_fraction));
    row("Error of predicting measured pixels, median / 95th percentile",
        percent(c.prediction_error_median) + " / " + percent(c.prediction_error_p95));
    row("Ambient over white", percent(c.ambient_fraction));
    row("Design white, Y at the eye", fmt::format("{:.4g}", result.design_white_y));
    row("Mock-up in the picture",
        fmt::format(
            "{} of it, {} pixels long", percent(result.covered_fraction), result.mockup_length_px));
    row("Pose and lenses", pose_note(result));
    row("Picture off its place, median / 95th percentile", off_note(result));
    html += "</table>\n";
    for (const auto& warning : c.warnings) {
        html += fmt::format("<p class=\"warning\">{}</p>\n", html_escaped(warning));
    }
    return html + "</section>\n";
}

std::string seconds_section(const DemoResult& result) {
    std::string html = "<section><h2>Seconds</h2><table>\n";
    for (const auto& [stage, seconds] : result.seconds) {
        html += fmt::format("<tr><th>{}</th><td>{:.2f}</td></tr>\n", html_escaped(stage), seconds);
    }
    for (const DesignResult& design : result.designs) {
        html += fmt::format(
            "<tr><th>{}: shading, compensation</th><td>{:.1f} ms, {:.1f} ms</td></tr>\n",
            html_escaped(design.name),
            design.shade_ms,
            design.compensate_ms);
    }
    return html +
           fmt::format("</table><p>OpenGL: {}</p></section>\n", html_escaped(result.renderer));
}

std::string paper_section() {
    std::string html =
        "<section><h2>The paper's vote</h2><p>Counts published in Table 3 of Park, Lim, Seo, Jung, "
        "Lee: "
        "Spatial augmented reality for product appearance design evaluation (2015), ten "
        "evaluators. "
        "They are quoted for comparison; nobody voted in this run.</p>"
        "<table><tr><th></th><th>(a)</th><th>(b)</th><th>(c)</th><th>(d)</th></tr>\n<tr><th>Best</"
        "th>";
    for (const int count : kPaperBest) html += fmt::format("<td>{}</td>", count);
    html += "</tr>\n<tr><th>Second best</th>";
    for (const int count : kPaperSecond) html += fmt::format("<td>{}</td>", count);
    return html + "</tr></table></section>\n";
}

constexpr const char* kStyle = R"(
:root { color-scheme: dark; }
body { background: #16181b; color: #e4e6e8; font: 16px/1.5 system-ui, sans-serif; margin: 2rem auto;
       max-width: 1320px; padding: 0 1.5rem; }
h1 { font-weight: 600; margin-bottom: .2rem; } h2 { margin: 2.2rem 0 .4rem; font-weight: 600; }
.row { display: grid; grid-template-columns: repeat(auto-fit, minmax(280px, 1fr)); gap: 1rem; }
figure { margin: 0; } img { width: 100%; height: auto; background: #000; border-radius: 4px; }
figcaption, caption { color: #a9afb6; font-size: .9rem; text-align: left; padding: .3rem 0; }
table { border-collapse: collapse; margin: .6rem 0; } th { text-align: left; font-weight: 500; }
th, td { padding: .3rem .9rem .3rem 0; border-bottom: 1px solid #2c3036; vertical-align: top; }
td { font-variant-numeric: tabular-nums; } .verdict { margin: .2rem 0 .8rem; color: #a9afb6; }
.warning { border-left: 3px solid #d9a441; padding-left: .8rem; }
)";

}  // namespace

Json figures_of(const DemoResult& result) {
    Json designs = Json::array();
    for (const DesignResult& design : result.designs) {
        Json entry = {
            {"name", design.name},
            {"de00_median", figures_of(design.seen.corrected.interior)["median"]},
            {"de00_p95", figures_of(design.seen.corrected.interior)["p95"]},
            {"de00_uncompensated_median", figures_of(design.seen.uncorrected.interior)["median"]},
            {"de00", figures_of(design.seen.corrected.interior)},
            {"de00_edge_band", figures_of(design.seen.corrected.edge)},
            {"de00_clipped", figures_of(design.seen.corrected.clipped)},
            {"de00_predicted", figures_of(design.seen.corrected.predicted)},
            {"de00_reachable_with_masked", figures_of(design.seen.corrected.reachable_with_masked)},
            {"de00_uncompensated", figures_of(design.seen.uncorrected.interior)},
            {"reachable_fraction", design.seen.corrected.reachable_fraction},
            {"valid_fraction", design.seen.corrected.valid_fraction},
            {"unlit_fraction", design.unlit_fraction},
            {"de00_projector_pixels", figures_of(design.pixels.corrected.interior)},
            {"masked_fraction", design.seen.corrected.masked_fraction},
            {"predicted_fraction", design.seen.corrected.predicted_fraction},
            {"out_of_gamut_fraction", design.out_of_gamut_fraction},
            {"shade_ms", design.shade_ms},
            {"compensate_ms", design.compensate_ms},
            {"verdict", verdict(design)}};
        if (design.seen.chart_corrected) {
            entry["de00_chart_matrix"] = figures_of(design.seen.chart_corrected->interior);
        }
        designs.push_back(entry);
    }
    Json seconds = Json::object();
    for (const auto& [stage, value] : result.seconds) seconds[stage] = value;
    const ColourCalibration& c = result.calibration;
    return {{"bench", result.bench_name},
            {"simulated", true},
            {"product", result.product_name},
            {"renderer", result.renderer},
            {"pose", pose_note(result)},
            {"pose_from_photographs", result.room.has_value()},
            {"picture_off_px", figures_of(result.picture_off_px)},
            {"covered_fraction", result.covered_fraction},
            {"mockup_length_px", result.mockup_length_px},
            {"design_white_y", result.design_white_y},
            {"designs", designs},
            {"calibration",
             {{"id", c.id},
              {"mode", c.mode},
              {"additive", c.table.grid == 0},
              {"additivity_error", c.additivity_error},
              {"condition_p99", c.condition_p99},
              {"valid_fraction", c.valid_fraction},
              {"predicted_fraction", c.predicted_fraction},
              {"prediction_error_median", c.prediction_error_median},
              {"prediction_error_p95", c.prediction_error_p95},
              {"ambient_fraction", c.ambient_fraction},
              {"camera_to_xyz", c.xyz_origin},
              {"warnings", c.warnings}}},
            {"seconds", seconds},
            {"paper_table_3", {{"best", kPaperBest}, {"second", kPaperSecond}}},
            {"report", result.report.string()}};
}

void write_report(const std::filesystem::path& file, const DemoResult& result) {
    std::string html = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src 'self' "
        "file: data:; "
        "style-src 'unsafe-inline'\">"
        "<title>Livery: {0} on the {1} bench</title><style>{2}</style></head><body>\n"
        "<h1>{0} on the {1} bench</h1>\n<p>Every figure here is simulated: the bench is a spectral "
        "model of "
        "projector, mock-up, room and camera. The calibration saw only its photographs.</p>\n",
        html_escaped(result.product_name),
        html_escaped(result.bench_name),
        kStyle);
    html += design_table(result);
    for (const DesignResult& design : result.designs) html += design_section(design);
    html +=
        "<p><img src=\"pictures/difference-legend.png\" alt=\"legend\" style=\"max-width:320px\"> "
        "CIEDE2000 0 to 5; grey: not part of the mock-up</p>\n";
    html += calibration_section(result) + seconds_section(result) + paper_section();
    html += "</body></html>\n";
    write_text_file(file, html);
}

std::string summary_of(const DemoResult& result) {
    std::string text = fmt::format(
        "{} on the simulated bench \"{}\"; CIEDE2000 median / 95th percentile in the eye's "
        "picture\n",
        result.product_name,
        result.bench_name);
    text += fmt::format("{:<24}{:>16}{:>18}{:>18}{:>16}{:>10}{:>11}{:>9}{:>18}\n",
                        "look",
                        "corrected",
                        "uncorrected",
                        "chart matrix",
                        "predicted px",
                        "in reach",
                        "predicted",
                        "masked",
                        "at the pixels");
    const auto pair = [](const ErrorStatistics& s) {
        return s.pixels == 0 ? std::string("none")
                             : fmt::format("{:.2f} / {:.2f}", s.median, s.p95);
    };
    for (const DesignResult& design : result.designs) {
        text += fmt::format(
            "{:<24}{:>16}{:>18}{:>18}{:>16}{:>10}{:>11}{:>9}{:>18}\n",
            design.name,
            pair(design.seen.corrected.interior),
            pair(design.seen.uncorrected.interior),
            design.seen.chart_corrected ? pair(design.seen.chart_corrected->interior) : "not run",
            pair(design.seen.corrected.predicted),
            percent(design.seen.corrected.reachable_fraction),
            percent(design.seen.corrected.predicted_fraction),
            percent(design.seen.corrected.masked_fraction),
            pair(design.pixels.corrected.interior));
    }
    text += fmt::format("{}; picture off its place {}\n", pose_note(result), off_note(result));
    for (const auto& warning : result.calibration.warnings) text += "warning: " + warning + "\n";
    text += fmt::format("calibration {}; {:.1f} s in all; report and pictures: {}\n",
                        result.calibration.id,
                        result.seconds.empty() ? 0.0 : result.seconds.back().second,
                        result.report.string());
    return text;
}

}  // namespace livery
