// livery desktop

#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "live/frame_thread.h"
#include "studio/product/new_session.h"
#include "studio/window/app.h"

namespace livery {

Command desktop_command() {
    struct Arguments {
        std::string file, session, product, unit, size, ui_map, trace, shading = "auto";
        double ui_scale = 0.0;
    };
    const auto arguments = std::make_shared<Arguments>();
    Command command;
    command.name = "desktop";
    command.summary = "open the desktop program; so does livery alone";
    command.example = "livery desktop --session roadster.livery";
    command.options = {
        // File managers give a file without an option.
        {"file",
         "FILE",
         "a session, as --session; a mesh (.glb, .gltf, .ply, .obj) or product file (.json) begins "
         "a new session with it",
         &arguments->file},
        {"--session",
         "FILE",
         "the session, made when it is not there (default: in your folder)",
         &arguments->session},
        {"--product",
         "NAME",
         "what a new session shows: a file, car, player or sphere (default car)",
         &arguments->product},
        unit_option(arguments->unit),
        {"--ui-scale",
         "X",
         "size of letters and controls, 0.5 to 4 (default: the screen's)",
         &arguments->ui_scale},
        {"--size", "WxH", "size of the window (default: as it was)", &arguments->size},
        {"--ui-map",
         "FILE",
         "keep a JSON file of where everything in the window is",
         &arguments->ui_map},
        {"--trace",
         "FILE",
         "write when inputs, frames and pictures happened, a JSON line each",
         &arguments->trace},
        {"--shading",
         "DEVICE",
         "what shades and corrects the mock-up's picture: auto, opengl or processor (default auto: "
         "opengl unless it is software)",
         &arguments->shading,
         false,
         {"auto", "opengl", "processor"}},
    };
    command.run = [arguments](const CommonOptions&, const Progress&) {
        DesktopOptions options;
        options.session = arguments->session;
        if (is_product_path(arguments->file)) {
            options.new_product = arguments->file;
            std::error_code error;
            if (!std::filesystem::is_regular_file(options.new_product, error)) {
                throw FileError(arguments->file, "", "no such file", "a mesh or a product file");
            }
            // A session that is not there is the one to be made of it, not one of the car.
            if (!std::filesystem::exists(options.session, error)) {
                options.new_session = std::exchange(options.session, {});
            }
        } else if (!arguments->file.empty()) {
            if (!arguments->session.empty()) {
                throw std::invalid_argument("--session: found a session twice, expected one");
            }
            options.session = arguments->file;
        }
        options.product = arguments->product;
        options.unit = parse_unit(arguments->unit);
        options.ui_map = arguments->ui_map;
        options.trace = arguments->trace;
        if (arguments->shading == "opengl") options.shading = ShadingDevice::gl;
        if (arguments->shading == "processor") options.shading = ShadingDevice::processor;
        if (arguments->ui_scale != 0.0) {
            if (arguments->ui_scale < 0.5 || arguments->ui_scale > 4.0) {
                throw std::invalid_argument(
                    fmt::format("--ui-scale: found {}, expected 0.5 to 4", arguments->ui_scale));
            }
            options.ui_scale = arguments->ui_scale;
        }
        if (!arguments->size.empty()) {
            const glm::ivec2 size = parse_size("--size", arguments->size);
            options.size_px = size;
        }
        Outcome outcome;
        outcome.exit_code = run_desktop(options);
        return outcome;
    };
    return command;
}

}  // namespace livery
