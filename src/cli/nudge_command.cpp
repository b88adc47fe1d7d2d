// livery calibrate nudge
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "jobs/calibrate/calibration_folder.h"
#include "jobs/calibrate/nudged_calibration.h"
#include "scene/library.h"
#include "scene/nudge.h"

namespace livery {

Command calibrate_nudge_command() {
    struct Arguments {
        std::string calibration, product = "car", out;
        Nudge by;
    };
    const auto arguments = std::make_shared<Arguments>();
    Nudge& by = arguments->by;
    Command command;
    command.name = "calibrate nudge";
    command.summary = "a calibration -> another whose mock-up stands a little elsewhere";
    command.example =
        "livery calibrate nudge --calibration calibration --right -1.5 --down 2 --out nudged";
    command.options = {
        {"--calibration", "DIR", "with its projector.json", &arguments->calibration, true, {}},
        {"--product", "FILE|NAME", "the mock-up (default car)", &arguments->product, false, {}},
        {"--right", "PX", "the lines move to the right, projector pixels", &by.right_px, false, {}},
        {"--down", "PX", "they move down", &by.down_px, false, {}},
        {"--nearer", "PX", "they grow, at the mock-up's rim", &by.nearer_px, false, {}},
        {"--yaw", "PX", "the mock-up's front turns to the right", &by.yaw_px, false, {}},
        {"--pitch", "PX", "its front turns down", &by.pitch_px, false, {}},
        {"--roll", "PX", "it turns clockwise", &by.roll_px, false, {}},
        {"--out", "DIR", "the new calibration's folder", &arguments->out, true, {}},
    };
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        const std::filesystem::path from = arguments->calibration;
        const auto before = projector_view_of(from);
        if (!before)
            throw FileError(from / "projector.json", "", "nothing", "the projector's camera file");
        progress.update(0.0, "reading the mock-up");
        const auto product = find_product(arguments->product);
        const Bounds bounds = bounds_of(product->mesh);
        const View after = nudged(*before, bounds, arguments->by);
        progress.update(0.5, "writing");
        Outcome outcome;
        const std::string id = write_nudged(from, arguments->out, after, bounds);
        const MockupMotion motion = motion_between(*before, after, bounds);
        outcome.figures = {{"id", id},
                           {"moved_mm", {motion.moved_mm.x, motion.moved_mm.y, motion.moved_mm.z}},
                           {"moved_px", {motion.moved_px.x, motion.moved_px.y}},
                           {"turned_deg", motion.turned_deg}};
        outcome.text =
            fmt::format("{}: calibration {} in {}\n", in_words(motion), id, arguments->out);
        return outcome;
    };
    return command;
}

}  // namespace livery
