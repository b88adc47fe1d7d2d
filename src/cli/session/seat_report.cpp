#include "cli/session/seat_report.h"

#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/image_io.h"
#include "core/paths.h"
#include "core/pictures/picture_means.h"
#include "jobs/comparison.h"
#include "jobs/seat_errors.h"
#include "live/seat_error_thread.h"

namespace livery {

namespace {

std::optional<int> whole_number(const std::string& text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

std::vector<int> looks_of(const Document& document, const std::string& look) {
    std::vector<int> looks;
    for (const SessionLook& one : document.looks) {
        if (look == "all" || whole_number(look) == one.id) looks.push_back(one.id);
    }
    if (!looks.empty()) return looks;
    throw std::invalid_argument(
        fmt::format("--look: found \"{}\", expected a look's number or all", look));
}

Json eye_json(const Document& document) {
    return {{"of", in_words(document.seats, document.eye_choice)},
            {"eye_mm", json_from(eye_in_use_mm(document))}};
}

Json json_of(const EyeSeat& seat) {
    return {{"seat", seat.number}, {"eye_mm", json_from(seat.eye_mm)}, {"counts", seat.counts}};
}

std::string place_text(const glm::dvec3& x_mm) {
    return fmt::format("{:8.0f} {:8.0f} {:8.0f}", x_mm.x, x_mm.y, x_mm.z);
}

}  // namespace

EyeChoice parse_eye_choice(const std::string& option, const std::string& text) {
    if (text == "hand") return {EyeSource::by_hand, 0};
    if (text == "mean") return {EyeSource::mean, 0};
    if (const auto number = whole_number(text); number && *number >= 1) {
        return {EyeSource::seat, *number};
    }
    throw std::invalid_argument(
        fmt::format("{}: found \"{}\", expected hand, mean or a seat's number", option, text));
}

Outcome seats_told(const Document& document) {
    Outcome outcome;
    outcome.figures = {{"eye", eye_json(document)}, {"seats", Json::array()}};
    outcome.text = fmt::format("eye {:<22} {} mm\n",
                               in_words(document.seats, document.eye_choice),
                               place_text(eye_in_use_mm(document)));
    for (const EyeSeat& seat : document.seats) {
        outcome.figures["seats"].push_back(json_of(seat));
        outcome.text += fmt::format("seat {:<21} {} mm{}\n",
                                    seat.number,
                                    place_text(seat.eye_mm),
                                    seat.counts ? "" : ", does not count in the mean");
    }
    if (document.seats.empty()) outcome.text += "no seats\n";
    return outcome;
}

Outcome seats_told(const Document& document,
                   const std::string& look,
                   const std::shared_ptr<const Product>& product,
                   const ProjectorSetup& setup,
                   const std::filesystem::path& maps,
                   const Progress& progress) {
    const std::vector<int> looks = looks_of(document, look);
    if (document.seats.empty()) {
        throw Refused("the session has no seats", "livery session seats FILE --arc 5 places some");
    }
    if (!maps.empty()) make_output_folder(maps);
    Outcome outcome = seats_told(document);
    SeatPictures pictures(product,
                          seat_error_view(setup.view),
                          seat_error_levels(document.quality, document.levels),
                          progress.part(0.0, 0.2));
    const double steps = static_cast<double>(looks.size() * (document.seats.size() + 1));
    double done = 0.0;
    const auto draw = [&](const Scene& scene, const glm::dvec3& eye_mm) {
        progress.update(0.2 + 0.8 * done++ / steps, "shading for each seat");
        const Progress silent{{}, progress.stop};
        return pictures.drawn_for(scene, eye_mm, silent);
    };
    std::vector<bool> fair(document.seats.size(), true);
    outcome.text += fmt::format(
        "\n{:<6} {:<24} {:>8} {:>8} {:>8}\n", "seat", "look", "median", "95%", "over 3");
    for (const int id : looks) {
        const Scene scene = scene_of(document, id, product);
        const ImageF projected = draw(scene, scene.eye_in_world_mm);
        const std::string name = find_look(document, id)->look.name;
        for (std::size_t k = 0; k < document.seats.size(); ++k) {
            const EyeSeat& seat = document.seats[k];
            const ImageF de00 = colour_difference_map(projected, draw(scene, seat.eye_mm));
            const SeatError error = seat_error(de00);
            fair[k] = fair[k] && is_fair(error);
            Json figures = {{"look", id},
                            {"name", name},
                            {"de00_median", error.de00_median},
                            {"de00_p95", error.de00_p95},
                            {"share_over_3", error.share_over}};
            if (!maps.empty()) {
                const auto file = maps / fmt::format("look-{}-seat-{}.png", id, seat.number);
                write_png(file, difference_map(de00, kSeatMapScale));
                figures["map"] = file.string();
            }
            outcome.figures["seats"][k]["looks"].push_back(std::move(figures));
            outcome.text += fmt::format("{:<6} {:<24} {:>8.2f} {:>8.2f} {:>7.1f}%\n",
                                        seat.number,
                                        name,
                                        error.de00_median,
                                        error.de00_p95,
                                        100.0 * error.share_over);
        }
    }
    std::vector<int> unfair;
    for (std::size_t k = 0; k < fair.size(); ++k) {
        if (!fair[k]) unfair.push_back(document.seats[k].number);
    }
    outcome.figures["unfair_seats"] = unfair;
    if (!unfair.empty()) {
        outcome.text += fmt::format(
            "seats {} see other looks than they should: more than a fifth of one is over 3\n",
            fmt::join(unfair, ", "));
    }
    return outcome;
}

}  // namespace livery
