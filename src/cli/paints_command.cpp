// livery paints
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/fit/recolour.h"
#include "appearance/material.h"
#include "appearance/material_json.h"
#include "appearance/material_library.h"
#include "appearance/model_table.h"
#include "appearance/paint_colour.h"
#include "appearance/paint_figures.h"
#include "appearance/paint_search.h"
#include "cli/command.h"
#include "core/error.h"
#include "core/json.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/text/markup.h"
#include "ledger/paint_cost.h"

namespace livery {

namespace {

struct ListedPaint {
    Material material;
    PaintFigures figures;
    PaintCost cost;
    std::optional<double> de00{};  ///< from the colour that was asked for
};

/// "measured" or "designed": the first word of a provenance.
std::string origin_of(const Material& material) {
    const std::string& text = material.provenance;
    for (const char* origin : {"measured", "designed"}) {
        if (text.starts_with(std::string(origin) + ":")) return origin;
    }
    return "";
}

std::string flop_text(const std::optional<double>& flop) {
    return flop ? fmt::format("{:.1f}", *flop) : "-";
}

/// "32, 53, 33"; nothing is -0.
std::string whole(const glm::dvec3& v) {
    const auto rounded = [](double value) { return std::lround(value); };
    return fmt::format("{}, {}, {}", rounded(v.x), rounded(v.y), rounded(v.z));
}

Json lab_numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// With their figures, in the same order. Throws FileError, Cancelled.
std::vector<ListedPaint> listed(const std::vector<Material>& paints, const Progress& progress) {
    std::vector<ListedPaint> list(paints.size());
    progress.update(0.0, "figures of paints");
    const std::vector<PassCost> costs = known_pass_costs().passes;
    parallel_for(paints.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            list[i] = {paints[i], paint_figures(paints[i]), paint_cost(paints[i], costs)};
        }
    });
    return list;
}

/// A line a paint, under a line of headings.
std::string list_of(const std::vector<ListedPaint>& paints) {
    std::size_t widest = 5;
    for (const ListedPaint& paint : paints) {
        widest = std::max(widest, paint.material.name.size());
    }
    const bool near = std::any_of(
        paints.begin(), paints.end(), [](const ListedPaint& paint) { return paint.de00; });
    std::string text = fmt::format("{:<{}}  {:<9} {:<9} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6}{}\n",
                                   "paint",
                                   widest,
                                   "family",
                                   "origin",
                                   "L* 45",
                                   "a*",
                                   "b*",
                                   "flop",
                                   "GU 20",
                                   "GU 60",
                                   near ? "  CIEDE2000" : "");
    for (const ListedPaint& paint : paints) {
        const glm::dvec3& face = paint.figures.lab[kFaceAngle];
        text +=
            fmt::format("{:<{}}  {:<9} {:<9} {:>6.1f} {:>6.1f} {:>6.1f} {:>6} {:>6.1f} {:>6.1f}",
                        paint.material.name,
                        widest,
                        paint.material.family,
                        origin_of(paint.material),
                        face.x,
                        face.y,
                        face.z,
                        flop_text(paint.figures.flop),
                        paint.figures.gloss_20,
                        paint.figures.gloss_60);
        text += paint.de00 ? fmt::format("  {:>9.2f}\n", *paint.de00) : "\n";
    }
    return text;
}

/// Every figure of one.
std::string page_of(const ListedPaint& paint) {
    const Material& material = paint.material;
    std::string text =
        fmt::format("{} ({}), model {}\n{}\n\n",
                    material.name,
                    material.family.empty() ? "no family" : material.family,
                    model_info(material.model).name,
                    material.provenance.empty() ? "origin not told" : material.provenance);
    text += "light at 45 degrees, D65, 10 degree observer:\n";
    text += fmt::format("  {:<18} {:>8} {:>8} {:>8}\n", "from the mirror", "L*", "a*", "b*");
    for (std::size_t k = 0; k < kAspecularAngles_deg.size(); ++k) {
        const glm::dvec3& lab = paint.figures.lab[k];
        text += fmt::format("  {:>3.0f} degrees        {:>8.2f} {:>8.2f} {:>8.2f}\n",
                            kAspecularAngles_deg[k],
                            lab.x,
                            lab.y,
                            lab.z);
    }
    text += fmt::format("flop index: {}\n",
                        paint.figures.flop ? fmt::format("{:.2f}", *paint.figures.flop)
                                           : "none, too dark at 45 degrees");
    text += fmt::format("gloss at 20 degrees: {:.1f} GU, at 60 degrees: {:.1f} GU\n",
                        paint.figures.gloss_20,
                        paint.figures.gloss_60);
    if (has_glints(material)) {
        text += fmt::format("glints: {:.4g} flakes on a square millimetre, {}\n",
                            material.glint_density_per_mm2,
                            glint_scale_text(material));
    }
    text += paint.cost.ns_a_pixel
                ? fmt::format("shading: {:.1f} ns a pixel, predicted\n", *paint.cost.ns_a_pixel)
                : fmt::format("shading: cost unknown, {}\n", paint.cost.why_not);
    if (paint.de00)
        text += fmt::format("CIEDE2000 from the colour asked for: {:.2f}\n", *paint.de00);
    return text;
}

Json json_of(const ListedPaint& paint) {
    const Material& material = paint.material;
    Json json = json_of(material);
    json["file"] = material.file.string();
    json["origin"] = origin_of(material);
    json["aspecular_deg"] = kAspecularAngles_deg;
    json["lab"] = Json::array();
    for (const glm::dvec3& lab : paint.figures.lab) json["lab"].push_back(lab_numbers(lab));
    json["lab_45"] = lab_numbers(paint.figures.lab[kFaceAngle]);
    json["flop_index"] = paint.figures.flop ? Json(*paint.figures.flop) : Json(nullptr);
    json["gloss_20"] = paint.figures.gloss_20;
    json["gloss_60"] = paint.figures.gloss_60;
    json["shading_ns_a_pixel"] =
        paint.cost.ns_a_pixel ? Json(*paint.cost.ns_a_pixel) : Json(nullptr);
    if (!paint.cost.ns_a_pixel) json["shading_unknown_because"] = paint.cost.why_not;
    if (paint.de00) json["de00"] = *paint.de00;
    return json;
}

/// The table of docs/materials.md.
std::string markdown_of(const std::vector<ListedPaint>& paints) {
    std::string text =
        "| paint | family | origin | model | L\\*a\\*b\\* at 15 degrees | 25 | 45 | 75 | 110 | "
        "flop | "
        "gloss 20 | 60 |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    for (const ListedPaint& paint : paints) {
        text += fmt::format("| {} | {} | {} | `{}` |",
                            paint.material.name,
                            paint.material.family,
                            origin_of(paint.material),
                            model_info(paint.material.model).name);
        for (const glm::dvec3& lab : paint.figures.lab) {
            text += fmt::format(" {} |", whole(lab));
        }
        text += fmt::format(" {} | {:.0f} | {:.0f} |\n",
                            flop_text(paint.figures.flop),
                            paint.figures.gloss_20,
                            paint.figures.gloss_60);
    }
    return text;
}

struct PaintsArguments {
    std::string name, search, family, near, chip, tint, out, markdown;
};

/// A colour as it is typed, or a chip of a table.
glm::dvec3 colour_of(const std::string& option, const std::string& text, const std::string& chip) {
    if (text.ends_with(".csv")) {
        check_argument(!chip.empty(),
                       fmt::format("{} {}: which chip? name one with --chip", option, text));
        return chip_named(read_colour_chips(text), chip).lab10;
    }
    check_argument(chip.empty(), fmt::format("--chip is for {} FILE.csv, found {}", option, text));
    return parse_colour(text);
}

void check_arguments(const PaintsArguments& arguments) {
    const bool one = !arguments.name.empty();
    const bool filtered = !arguments.search.empty() || !arguments.family.empty();
    check_argument(!one || !filtered, "NAME is one paint: leave --search and --family out");
    check_argument(one || arguments.tint.empty(), "--tint needs NAME, the paint to make it from");
    check_argument(arguments.tint.empty() == arguments.out.empty(),
                   "--tint and --out need each other");
    check_argument(arguments.near.empty() || arguments.tint.empty(),
                   "--near and --tint: one of them");
    check_argument(arguments.chip.empty() || !(arguments.near.empty() && arguments.tint.empty()),
                   "--chip is for --near FILE.csv or --tint FILE.csv");
    check_argument(arguments.markdown.empty() || (!one && !filtered && arguments.near.empty()),
                   "--markdown writes the whole library: leave NAME, --search, --family and --near "
                   "out");
}

/// All paints, the shipped first.
std::vector<Material> all_of(const PaintLibrary& library) {
    std::vector<Material> all = library.shipped;
    all.insert(all.end(), library.users.begin(), library.users.end());
    return all;
}

std::set<std::string> families_of(const std::vector<Material>& paints) {
    std::set<std::string> families;
    for (const Material& paint : paints) families.insert(paint.family);
    families.erase("");
    return families;
}

std::vector<ListedPaint> found(const PaintsArguments& arguments,
                               const std::vector<Material>& all,
                               const Progress& progress) {
    const auto families = families_of(all);
    check_argument(
        arguments.family.empty() || families.contains(arguments.family),
        fmt::format(
            "--family: found {}, expected one of {}", arguments.family, fmt::join(families, ", ")));
    std::vector<Material> paints;
    for (const std::size_t i : search_paints(all, arguments.search, arguments.family)) {
        paints.push_back(all[i]);
    }
    std::vector<ListedPaint> list = listed(paints, progress);
    if (arguments.near.empty()) return list;
    std::vector<glm::dvec3> faces;
    for (const ListedPaint& paint : list) faces.push_back(paint.figures.lab[kFaceAngle]);
    std::vector<ListedPaint> sorted;
    const glm::dvec3 wanted = colour_of("--near", arguments.near, arguments.chip);
    for (const NearPaint& near : nearest_colours(faces, wanted)) {
        sorted.push_back(list[near.index]);
        sorted.back().de00 = near.de00;
    }
    return sorted;
}

Outcome list_paints(const PaintsArguments& arguments, const Progress& progress) {
    const PaintLibrary library = *read_whole_paint_library();
    const std::vector<Material> all = all_of(library);
    const auto list = found(arguments, all, progress);
    Outcome outcome;
    outcome.figures = {
        {"paints", Json::array()}, {"families", families_of(all)}, {"problems", library.problems}};
    for (const ListedPaint& paint : list) outcome.figures["paints"].push_back(json_of(paint));
    outcome.text = list.empty() ? "no paint answers\n" : list_of(list);
    for (const std::string& problem : library.problems) {
        outcome.text += "left out: " + problem + "\n";
    }
    return outcome;
}

Outcome write_table(const PaintsArguments& arguments, const Progress& progress) {
    check_marked_block(arguments.markdown, "paints");
    const std::vector<Material> shipped = read_paint_library()->shipped;
    replace_marked_block(arguments.markdown, "paints", markdown_of(listed(shipped, progress)));
    Outcome outcome;
    outcome.figures = {{"file", arguments.markdown}, {"paints", shipped.size()}};
    outcome.text = fmt::format("{} paints into {}\n", shipped.size(), arguments.markdown);
    return outcome;
}

Outcome make_paint(const PaintsArguments& arguments, const Progress& progress) {
    const Recoloured made = with_colour(find_material(arguments.name),
                                        colour_of("--tint", arguments.tint, arguments.chip));
    if (!made.reached) {
        throw Refused(fmt::format("this colour cannot be had: it is {}; the nearest is CIEDE2000 "
                                  "{:.1f} away",
                                  made.why_not,
                                  made.de00),
                      "choose another finish or another colour");
    }
    ListedPaint paint = listed({made.material}, progress).front();
    paint.de00 = made.de00;
    paint.material.name = std::filesystem::path(arguments.out).stem().string();
    paint.material.file = arguments.out;
    write_material_file(arguments.out, paint.material);
    return {{{"paints", {json_of(paint)}}, {"file", arguments.out}},
            page_of(paint) + fmt::format("wrote {}\n", arguments.out)};
}

Outcome show_paint(const PaintsArguments& arguments, const Progress& progress) {
    ListedPaint paint = listed({find_material(arguments.name)}, progress).front();
    if (!arguments.near.empty()) {
        const glm::dvec3 wanted = colour_of("--near", arguments.near, arguments.chip);
        paint.de00 = nearest_colours(std::vector{paint.figures.lab[kFaceAngle]}, wanted)[0].de00;
    }
    return {{{"paints", {json_of(paint)}}}, page_of(paint)};
}

}  // namespace

Command paints_command() {
    const auto arguments = std::make_shared<PaintsArguments>();
    Command command;
    command.name = "paints";
    command.summary =
        "the paint library with the figures of paint makers: colour at five angles, "
        "flop, gloss; search by words, family or colour";
    command.example = "livery paints --near lab:38,50,30";
    const auto option = [&](const char* flag, const char* value, const char* help, auto* target) {
        command.options.push_back({flag, value, help, target});
    };
    option("name", "NAME", "one paint, by its name or file, with all figures", &arguments->name);
    option("--search", "WORDS", "paints whose names or families answer", &arguments->search);
    option("--family", "NAME", "paints of one family", &arguments->family);
    option("--near",
           "COLOUR",
           "nearest first: #RRGGBB, rgb(R, G, B), a CSS name, lab:L,a,b, xyz:X,Y,Z (D65, 10 "
           "degrees) or "
           "a CSV of chips",
           &arguments->near);
    option("--chip", "NAME", "which chip of the CSV", &arguments->chip);
    option("--tint", "COLOUR", "make a paint of NAME's finish in this colour", &arguments->tint);
    option("--out", "FILE", "where that paint is written, a material file", &arguments->out);
    option("--markdown",
           "FILE",
           "write the shipped paints as a table between the file's \"<!-- paints: begin -->\" and "
           "\"<!-- paints: end -->\"",
           &arguments->markdown);
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        check_arguments(*arguments);
        if (!arguments->markdown.empty()) return write_table(*arguments, progress);
        if (!arguments->tint.empty()) return make_paint(*arguments, progress);
        if (!arguments->name.empty()) return show_paint(*arguments, progress);
        return list_paints(*arguments, progress);
    };
    return command;
}

}  // namespace livery
