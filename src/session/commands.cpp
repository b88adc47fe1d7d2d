#include "session/commands.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "scene/library.h"
#include "session/naming.h"
#include "session/paint_edit.h"
#include "twin/description.h"

namespace livery {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kMostLooks = 10'000;

template <typename... Values>
[[noreturn]] void refuse(fmt::format_string<Values...> format, Values&&... values) {
    throw std::invalid_argument(fmt::format(format, std::forward<Values>(values)...));
}

void check_between(double value, double low, double high, const char* what) {
    if (!(value >= low && value <= high)) {
        refuse("{} is {}; expected a number from {} to {}", what, value, low, high);
    }
}

std::size_t index_of(const Document& document, int id) {
    std::string known;
    for (std::size_t k = 0; k < document.looks.size(); ++k) {
        if (document.looks[k].id == id) return k;
        known += fmt::format(
            "{}{} ({})", k ? ", " : "", document.looks[k].id, document.looks[k].look.name);
    }
    refuse("there is no look {}; there are {}", id, known);
}

Look& look_with(Document& document, int id) { return document.looks[index_of(document, id)].look; }

void check_part(const Document& document, const std::string& part) {
    if (part == "*") return;
    std::string known = "*";
    for (const std::string& name : part_names(document.product)) {
        if (name == part) return;
        known += ", " + name;
    }
    refuse("there is no part \"{}\" in {}; there are {}", part, document.product, known);
}

bool has_look_named(const Document& document, const std::string& name) {
    return std::any_of(document.looks.begin(), document.looks.end(), [&](const auto& look) {
        return look.look.name == name;
    });
}

std::vector<DirectionalLight> checked(std::vector<DirectionalLight> lights) {
    for (DirectionalLight& light : lights) {
        const double length = glm::length(light.direction);
        if (!std::isfinite(length) || !(length > 1e-12)) {
            refuse("a light's direction is [{}, {}, {}]; expected a finite vector with a length",
                   light.direction.x,
                   light.direction.y,
                   light.direction.z);
        }
        light.direction = unit_direction(light.direction);
        for (int c = 0; c < 3; ++c) {
            check_between(light.radiance_rec709[c], -1e6, 1e6, "a light's radiance");
        }
        check_between(light.angle_rad, 0.0, kPi, "a light's angle_rad");
    }
    return lights;
}

EnvironmentReference checked(EnvironmentReference environment) {
    if (environment.file.empty()) return {};
    check_text(environment.file, "the environment's file");
    check_between(environment.rotation_rad, -100.0, 100.0, "the environment's rotation_rad");
    check_between(environment.scale, 0.0, 1e6, "the environment's scale");
    if (const auto problem = environment_problem(environment)) {
        throw std::invalid_argument(*problem);
    }
    return environment;
}

/// Adds the look behind or at a place, with a number and a name of its own.
void add_look(Document& document, Look look, std::size_t at) {
    if (document.looks.size() >= kMostLooks) {
        refuse("there are {} looks already; no more are possible", document.looks.size());
    }
    look.name = free_name(look.name,
                          [&](const std::string& name) { return has_look_named(document, name); });
    look.file.clear();
    look.exposure_ev = 0.0;
    document.looks.insert(document.looks.begin() + static_cast<std::ptrdiff_t>(at),
                          {document.next_look_id, std::move(look)});
    ++document.next_look_id;
}

void name_anew(const Document& document, Look& look, const std::string& name) {
    if (name.empty() || name == look.name) return;
    check_name(name, "the look's name");
    look.name =
        free_name(name, [&](const std::string& other) { return has_look_named(document, other); });
}

void apply(Document& document, const SetPaint& command) {
    Look& look = look_with(document, command.look);
    check_part(document, command.part);
    look.parts[command.part] = known_paint(document, command.paint);
    name_anew(document, look, command.look_name);
}

void apply(Document& document, const PaintProduct& command) {
    Look& look = look_with(document, command.look);
    look.parts = {{"*", known_paint(document, command.paint)}};
    look.artwork.clear();
    name_anew(document, look, command.look_name);
}

void apply(Document& document, const EditPaint& command) {
    index_of(document, command.look);
    check_part(document, command.part);
    edit_paint(document, command);
}

void apply(Document& document, const RenamePaint& command) { rename_paint(document, command); }

void check_only_relief(const std::vector<Artwork>& list, const Artwork& relief) {
    for (const Artwork& other : list) {
        const bool same_part = other.part == relief.part || other.part == "*" || relief.part == "*";
        if (&other != &relief && is_relief(other) && same_part) {
            refuse("part {} would have two reliefs; expected one at most", relief.part);
        }
    }
}

/// Names as the session has them; whatever cannot be drawn is refused.
std::vector<Artwork> checked(const Document& document, const Look& look) {
    std::vector<Artwork> list = look.artwork;
    if (list.size() > kMostArtworks) {
        refuse("there are {} artworks; expected at most {}", list.size(), kMostArtworks);
    }
    for (Artwork& artwork : list) {
        check_artwork(artwork);
        if (!artwork.name.empty()) check_text(artwork.name, "the artwork's name");
        check_part(document, artwork.part);
        std::shared_ptr<const ArtworkPicture> picture;
        try {
            if (!artwork.picture.empty()) {
                check_text(artwork.picture, "the artwork's picture");
                const auto file = find_artwork_picture(artwork.picture, "");
                picture = load_artwork_picture(file);
                std::error_code error;
                if (std::filesystem::is_regular_file(artwork.picture, error)) {
                    artwork.picture = std::filesystem::absolute(file).lexically_normal().string();
                }
            }
            if (is_relief(artwork)) check_only_relief(list, artwork);
            if (artwork.paint.empty()) continue;
            artwork.paint = known_paint(document, artwork.paint);
            make_part_artwork(0, artwork, find_paint(document, artwork.paint), picture);
        } catch (const FileError& error) {
            throw std::invalid_argument(error.what());
        }
    }
    return list;
}

void apply(Document& document, const SetArtwork& command) {
    Look& look = look_with(document, command.look);
    Look with = look;
    with.artwork = command.artwork;
    look.artwork = checked(document, with);
}

void apply(Document& document, const AddLook& command) {
    const auto count = static_cast<int>(document.looks.size());
    if (command.at < -1 || command.at > count) {
        refuse("the place is {}; expected 0 to {}, or -1 for the last", command.at, count);
    }
    Look look = portable_look(command.look);
    check_name(look.name, "the look's name");
    for (auto& [part, paint] : look.parts) {
        check_part(document, part);
        paint = known_paint(document, paint);
    }
    look.artwork = checked(document, look);
    look.lights = checked(look.lights);
    look.environment = checked(look.environment);
    add_look(
        document, std::move(look), static_cast<std::size_t>(command.at < 0 ? count : command.at));
}

void apply(Document& document, const DuplicateLook& command) {
    const std::size_t index = index_of(document, command.look);
    // Last, so that every other look keeps its place and its number key.
    add_look(document, document.looks[index].look, document.looks.size());
}

void apply(Document& document, const RenameLook& command) {
    Look& look = look_with(document, command.look);
    check_name(command.name, "the look's name");
    if (look.name != command.name && has_look_named(document, command.name)) {
        refuse("there is a look \"{}\" already; expected another name", command.name);
    }
    look.name = command.name;
}

void apply(Document& document, const DeleteLook& command) {
    const std::size_t index = index_of(document, command.look);
    if (document.looks.size() == 1) {
        refuse("\"{}\" is the last look; a session keeps at least one",
               document.looks[index].look.name);
    }
    document.looks.erase(document.looks.begin() + static_cast<std::ptrdiff_t>(index));
}

void apply(Document& document, const MoveLook& command) {
    const std::size_t from = index_of(document, command.look);
    const auto last = static_cast<int>(document.looks.size()) - 1;
    if (command.to < 0 || command.to > last) {
        refuse("the place is {}; expected 0 to {}", command.to, last);
    }
    const auto begin = document.looks.begin();
    const auto source = begin + static_cast<std::ptrdiff_t>(from);
    const auto target = begin + command.to;
    if (source < target) std::rotate(source, source + 1, target + 1);
    if (target < source) std::rotate(target, source, source + 1);
}

void apply(Document& document, const SetLights& command) {
    look_with(document, command.look).lights = checked(command.lights);
}

void apply(Document& document, const SetEnvironment& command) {
    look_with(document, command.look).environment = checked(command.environment);
}

void apply(Document& document, const ShareLighting& command) {
    const Look source = look_with(document, command.look);
    for (SessionLook& look : document.looks) {
        look.look.lights = source.lights;
        look.look.environment = source.environment;
    }
}

void apply(Document& document, const SetEye& command) {
    for (int c = 0; c < 3; ++c) {
        check_between(command.eye_mm[c], -kFarthestEye_mm, kFarthestEye_mm, "the eye");
    }
    document.eye_mm = command.eye_mm;
    document.eye_choice = {};
}

/// Seats in the order of their numbers. An eye that these seats do not have any more stays where
/// it was.
void take_seats(Document& document, std::vector<EyeSeat> seats) {
    if (const auto problem = seats_problem(seats)) throw std::invalid_argument(*problem);
    std::sort(seats.begin(), seats.end(), [](const EyeSeat& a, const EyeSeat& b) {
        return a.number < b.number;
    });
    if (choice_problem(seats, document.eye_choice)) {
        document.eye_mm = eye_in_use_mm(document);
        document.eye_choice = {};
    }
    document.seats = std::move(seats);
}

void apply(Document& document, const SetSeat& command) {
    std::vector<EyeSeat> seats = document.seats;
    std::erase_if(seats, [&](const EyeSeat& seat) { return seat.number == command.seat; });
    seats.push_back({command.seat, command.eye_mm, command.counts});
    take_seats(document, std::move(seats));
}

void apply(Document& document, const RemoveSeat& command) {
    if (!find_seat(document.seats, command.seat)) {
        refuse("there is no seat {}; there are {}", command.seat, document.seats.size());
    }
    std::vector<EyeSeat> seats = document.seats;
    std::erase_if(seats, [&](const EyeSeat& seat) { return seat.number == command.seat; });
    take_seats(document, std::move(seats));
}

void apply(Document& document, const SetSeats& command) { take_seats(document, command.seats); }

void apply(Document& document, const UseEye& command) {
    EyeChoice choice = command.choice;
    if (choice.source != EyeSource::seat) choice.seat = 0;
    if (const auto problem = choice_problem(document.seats, choice)) {
        throw std::invalid_argument(*problem);
    }
    document.eye_choice = choice;
}

void apply(Document& document, const SetExposure& command) {
    check_between(command.ev, -30.0, 30.0, "the exposure");
    document.exposure_ev = command.ev;
}

void apply(Document& document, const SetQuality& command) {
    if (command.levels) check_levels(*command.levels);
    document.quality = command.quality;
    document.levels = command.levels;
}

void apply(Document& document, const SetCalibration& command) {
    check_text(command.folder, "the calibration's folder");
    document.calibration.clear();
    if (command.folder.empty()) return;
    const auto folder = std::filesystem::absolute(command.folder).lexically_normal();
    std::error_code error;
    if (!std::filesystem::is_regular_file(folder / "calibration.json", error)) {
        refuse("there is no calibration.json in {}; expected a calibration's folder",
               folder.string());
    }
    document.calibration = folder.string();
}

void apply(Document& document, const SetBench& command) {
    check_text(command.bench, "the bench");
    try {
        read_bench_file(command.bench);
    } catch (const FileError& error) {
        throw std::invalid_argument(error.what());
    }
    document.bench = command.bench;
}

void apply(Document& document, const SetDesignWhite& command) {
    check_between(command.percentile, 0.0, 100.0, "the design white's percentile");
    document.design_white_percentile = command.percentile;
}

void apply(Document& document, const SetGamutMapping& command) {
    document.gamut_mapping = command.mapping;
}

}  // namespace

Look portable_look(Look look) {
    if (look.file.empty()) return look;
    const auto folder = std::filesystem::absolute(look.file).parent_path();
    const auto beside = [&](std::string& name) {
        std::error_code error;
        const auto file = folder / name;
        if (!name.empty() && std::filesystem::is_regular_file(file, error)) name = file.string();
    };
    for_each_file(look, beside);
    look.file.clear();
    return look;
}

std::string look_name_after(const Look& look, const std::string& part, const std::string& paint) {
    const std::string name = without_number(look.name);
    const auto is_name = [&](const std::string& worn) {
        return same_paint_name(worn, look.name) || same_paint_name(worn, name) ||
               same_paint_name(without_number(worn), look.name);
    };
    const auto worn = look.parts.find(part);
    const bool named_after_it =
        part.empty() ? std::any_of(look.parts.begin(),
                                   look.parts.end(),
                                   [&](const auto& one) { return is_name(one.second); })
                     : worn != look.parts.end() && is_name(worn->second);
    // A paint's file is no name
    const bool file = paint.find('/') != std::string::npos;
    return named_after_it && !file && !same_paint_name(paint, name) ? paint : "";
}

Document applied(const Document& document, const SessionCommand& command) {
    Document after = document;
    std::visit([&](const auto& one) { apply(after, one); }, command);
    return after;
}

}  // namespace livery
