#include "cli/places_option.h"

#include <stdexcept>

#include <fmt/format.h>

namespace livery {

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

}  // namespace livery
