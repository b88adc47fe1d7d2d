// livery compensate

#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/render/frame_options.h"
#include "compensation/compensation.h"
#include "core/error.h"
#include "core/image_io.h"
#include "jobs/render/render.h"
#include "scene/mockup_mask.h"

namespace livery {

Command compensate_command() {
    struct Arguments {
        std::string calibration, target, out, gamut = "strict";
        double design_white = kDesignWhitePercentile;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "compensate";
    command.summary = "wanted picture in projector pixels -> projector input";
    command.example =
        "livery compensate --calibration demo/calibration --target wanted.exr --out input.png";
    command.options = {
        {"--calibration", "DIR", "calibration folder", &arguments->calibration, true},
        {"--target",
         "FILE",
         "wanted picture, .exr, linear Rec.709, 1 = design white",
         &arguments->target,
         true},
        {"--out", "FILE", "projector input, .png", &arguments->out, true},
        {"--gamut",
         "HOW",
         "strict: clip; preserve: keep the hue (default strict)",
         &arguments->gamut,
         false,
         {"strict", "preserve"}},
        {"--design-white",
         "PERCENT",
         "percentile, over what the target covers, of the brightest neutral that becomes 1 "
         "(default 20)",
         &arguments->design_white},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        check_percentile("--design-white", arguments->design_white);
        if (const auto suffix = std::filesystem::path(arguments->out).extension();
            suffix != ".png") {
            throw FileError(arguments->out,
                            "suffix",
                            suffix.empty() ? "none" : suffix.string(),
                            ".png: device values, untagged");
        }
        const ColourCalibration calibration = read_calibration(arguments->calibration);
        const TargetPicture target =
            read_target_picture(arguments->target, calibration.width, calibration.height);
        const ImageF& wanted = target.wanted;
        const Image8 counted = target.has_coverage ? coverage_mask(wanted) : Image8();
        const DesignWhite white = design_white_of(
            calibration,
            arguments->design_white,
            counted,
            target.has_coverage ? "coverage" : "every valid pixel: the target has no coverage");
        const CompensationTable table =
            bake(calibration, white.y, parse_gamut_mapping(arguments->gamut));
        progress.update(0.5, "compensating");
        CompensationStats stats;
        const Image8 drive = compensate(table, wanted, &stats);
        write_png(arguments->out, drive);
        Outcome outcome;
        outcome.figures = {{"out_of_gamut_fraction", stats.out_of_gamut_fraction},
                           {"invalid_fraction", stats.invalid_fraction},
                           {"clipped_high_fraction", stats.clipped_high_fraction},
                           {"clipped_low_fraction", stats.clipped_low_fraction},
                           {"gamut", arguments->gamut},
                           {"calibration", {{"id", calibration.id}}},
                           {"file", arguments->out}};
        tell(white, outcome);
        outcome.text = fmt::format(
            "out of gamut {:.1f}% (too bright {:.1f}%, too dark {:.1f}%), left black {:.1f}%; "
            "{}; wrote {}\n",
            100.0 * stats.out_of_gamut_fraction,
            100.0 * stats.clipped_high_fraction,
            100.0 * stats.clipped_low_fraction,
            100.0 * stats.invalid_fraction,
            text_of(white),
            arguments->out);
        if (!target.has_coverage) {
            const std::string warning =
                "the target has no coverage (channel A): whatever the projector lights, a table "
                "too, counts for the design white, and a dark one makes the mock-up dim; write "
                "the target with A, as livery render does";
            outcome.figures["warnings"] = {warning};
            outcome.text += "warning: " + warning + "\n";
        }
        return outcome;
    };
    return command;
}

}  // namespace livery
