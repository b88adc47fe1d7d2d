#include "cli/capture_options.h"

#include <stdexcept>

#include <fmt/format.h>

#include "core/error.h"

namespace livery {

Option patterns_option(std::string& target) {
    return {"--patterns",
            "FILE|DIR",
            "what photographs without a manifest.json show, in the order of their names: the "
            "patterns' folder or its manifest",
            &target};
}

Option places_option(std::string& target) {
    return {"--places",
            "CODE",
            "gray: whole projector pixels; gray-and-phase: ten pictures of fringes more, which "
            "tell parts of a pixel (default gray)",
            &target,
            false,
            {"gray", "gray-and-phase"}};
}

PlaceCode parse_places(const std::string& text) {
    if (text == "gray") return PlaceCode::gray;
    if (text == "gray-and-phase") return PlaceCode::gray_and_phase;
    throw std::invalid_argument(
        fmt::format("--places: found \"{}\", expected gray or gray-and-phase", text));
}

void add_data_sheet_options(std::vector<Option>& options, DataSheets& sheets) {
    for (Option& option : std::vector<Option>{
             {"--throw-ratio",
              "R",
              "the projector's distance over its picture's width",
              &sheets.throw_ratio},
             {"--lens-shift",
              "S",
              "the picture's middle over the lens's axis, in picture heights (default 0.5)",
              &sheets.lens_shift},
             {"--focal-mm", "MM", "the camera's focal length", &sheets.focal_mm},
             {"--sensor-width-mm", "MM", "the camera's sensor", &sheets.sensor_width_mm},
             {"--lens-distance-mm",
              "MM",
              "between the two lenses, by a tape; with a board it checks --square-mm",
              &sheets.lens_distance_mm},
         })
        options.push_back(std::move(option));
}

bool is_any_given(const DataSheets& sheets) {
    return sheets.throw_ratio != 0.0 || sheets.focal_mm != 0.0 || sheets.sensor_width_mm != 0.0 ||
           sheets.lens_distance_mm != 0.0;
}

void check_whole(const DataSheets& sheets, const std::string& instead) {
    const auto need = [&](const char* option, double value) {
        check_argument(value > 0.0,
                       fmt::format("{}: found {}, expected more than 0{}", option, value, instead));
    };
    need("--throw-ratio", sheets.throw_ratio);
    need("--focal-mm", sheets.focal_mm);
    need("--sensor-width-mm", sheets.sensor_width_mm);
    need("--lens-distance-mm", sheets.lens_distance_mm);
}

}  // namespace livery
