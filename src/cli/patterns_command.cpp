// livery patterns

#include <memory>

#include <fmt/format.h>

#include "calibration/correspondence/patterns.h"
#include "capture/patterns_folder.h"
#include "cli/capture_options.h"
#include "cli/command.h"

namespace livery {

namespace {

void append(std::vector<Pattern>& all, std::vector<Pattern> more) {
    for (Pattern& pattern : more) all.push_back(std::move(pattern));
}

}  // namespace

Command patterns_command() {
    struct Arguments {
        std::string projector, out, kind = "all", places = "gray";
        int dark = 0, bright = 255;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "patterns";
    command.summary = "write the pictures to project, numbered, with manifest.json";
    command.example = "livery patterns --projector 1280x800 --out patterns";
    command.options = {
        {"--projector", "WxH", "the projector's resolution", &arguments->projector, true},
        {"--out", "DIR", "where they go", &arguments->out, true},
        {"--kind",
         "KIND",
         "geometry, color or all (default all)",
         &arguments->kind,
         false,
         {"geometry", "color", "all"}},
        places_option(arguments->places),
        {"--dark", "S", "drive of the dark grey picture (default 0)", &arguments->dark},
        {"--bright", "T", "drive of the bright grey picture (default 255)", &arguments->bright},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const glm::ivec2 size = parse_size("--projector", arguments->projector);
        if (arguments->dark < 0 || arguments->bright > 255 ||
            arguments->dark >= arguments->bright) {
            throw std::invalid_argument(
                fmt::format("--dark, --bright: found {} and {}, expected 0 <= dark < bright <= 255",
                            arguments->dark,
                            arguments->bright));
        }
        std::vector<Pattern> patterns;
        if (arguments->kind != "color") {
            append(patterns, place_patterns(parse_places(arguments->places), size.x, size.y));
        }
        progress.check_stop();
        if (arguments->kind != "geometry") {
            append(patterns, colour_patterns(size.x, size.y, arguments->dark, arguments->bright));
            progress.check_stop();
            append(patterns, mosaic_patterns(size.x, size.y, kMosaics));
        }
        progress.check_stop();
        // White and black again at the end: what moved or changed on the way shows between the two.
        if (arguments->kind == "all") {
            for (Pattern& pattern : geometry_patterns(size.x, size.y)) {
                if (pattern.role == "white" || pattern.role == "black") {
                    patterns.push_back(std::move(pattern));
                }
            }
        }
        std::vector<PatternFile> files;
        for (Pattern& pattern : patterns) {
            progress.check_stop();
            files.push_back({pattern.role, std::move(pattern.drive), pattern.drive_values});
        }
        write_patterns_folder(arguments->out, size.x, size.y, files, progress);
        Outcome outcome;
        Json list = Json::array();
        for (std::size_t k = 0; k < files.size(); ++k) {
            list.push_back({{"file", fmt::format("{:03}.png", k)}, {"role", files[k].role}});
        }
        outcome.figures = {{"patterns", list}, {"folder", arguments->out}};
        outcome.text = fmt::format(
            "{} patterns in {}: show them in this order, photograph each, put the photographs in a "
            "folder of their own, and say --patterns {} where it is read\n",
            files.size(),
            arguments->out,
            arguments->out);
        return outcome;
    };
    return command;
}

}  // namespace livery
