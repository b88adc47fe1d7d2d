// livery paints

#include <algorithm>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/fit/recolour.h"
#include "appearance/material_library.h"
#include "appearance/paint_colour.h"
#include "appearance/paint_search.h"
#include "cli/command.h"
#include "cli/paints_table.h"
#include "core/error.h"
#include "core/text/marked_block.h"

namespace livery {

namespace {

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
        command.options.push_back({flag, value, help, target, false, {}});
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
