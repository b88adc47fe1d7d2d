#include <fmt/format.h>

#include "session/commands.h"
#include "session/paint_edit.h"

namespace livery {

namespace {

std::string name_of(const Document& document, int id) {
    const SessionLook* look = find_look(document, id);
    return look ? look->look.name : std::to_string(id);
}

std::string part_name(const std::string& part) { return part == "*" ? "the rest" : part; }

/// A file or folder by its own name, without where it lies.
std::string short_name(const std::string& path) {
    const auto name = std::filesystem::path(path).filename().string();
    return name.empty() ? path : name;
}

/// As the library writes it, when there is such a paint.
std::string paint_name(const Document& document, const std::string& name) {
    try {
        return short_name(known_paint(document, name));
    } catch (const std::invalid_argument&) {
        return name;
    }
}

std::string label(const Document& before, const SetPaint& command) {
    return fmt::format("Paint {} {}", part_name(command.part), paint_name(before, command.paint));
}
std::string label(const Document& before, const PaintProduct& command) {
    return fmt::format("Paint the whole product {}", paint_name(before, command.paint));
}
std::string label(const Document&, const EditPaint& command) {
    return fmt::format("Edit {} on {}", command.material.name, part_name(command.part));
}
std::string label(const Document&, const RenamePaint& command) {
    return fmt::format("Rename paint {} to {}", command.paint, command.name);
}
std::string label(const Document& before, const SetArtwork& command) {
    return fmt::format("Change artwork of {}", name_of(before, command.look));
}
std::string label(const Document&, const AddLook& command) {
    return fmt::format("Add look {}", command.look.name);
}
std::string label(const Document& before, const DuplicateLook& command) {
    return fmt::format("Duplicate look {}", name_of(before, command.look));
}
std::string label(const Document& before, const RenameLook& command) {
    return fmt::format("Rename look {} to {}", name_of(before, command.look), command.name);
}
std::string label(const Document& before, const DeleteLook& command) {
    return fmt::format("Delete look {}", name_of(before, command.look));
}
std::string label(const Document& before, const MoveLook& command) {
    return fmt::format("Move look {}", name_of(before, command.look));
}
std::string label(const Document& before, const SetLights& command) {
    return fmt::format("Change lights of {}", name_of(before, command.look));
}
std::string label(const Document& before, const SetEnvironment& command) {
    return fmt::format("Change environment of {}", name_of(before, command.look));
}
std::string label(const Document& before, const ShareLighting& command) {
    return fmt::format("Light all looks as {}", name_of(before, command.look));
}
std::string label(const Document&, const SetEye&) { return "Move eye point"; }
std::string label(const Document& before, const SetSeat& command) {
    const EyeSeat* seat = find_seat(before.seats, command.seat);
    if (!seat) return fmt::format("Add seat {}", command.seat);
    if (seat->eye_mm != command.eye_mm || seat->counts == command.counts) {
        return fmt::format("Move seat {}", command.seat);
    }
    return command.counts ? fmt::format("Count seat {}", command.seat)
                          : fmt::format("Leave seat {} out", command.seat);
}
std::string label(const Document&, const RemoveSeat& command) {
    return fmt::format("Remove seat {}", command.seat);
}
std::string label(const Document&, const SetSeats& command) {
    const std::size_t count = command.seats.size();
    return count == 0 ? "Remove all seats"
                      : fmt::format("Place {} {}", count, count == 1 ? "seat" : "seats");
}
std::string label(const Document& before, const UseEye& command) {
    return "Draw for the eye " + in_words(before.seats, command.choice);
}
std::string label(const Document&, const SetExposure& command) {
    return fmt::format("Set exposure to {:.4g} EV", command.ev);
}
std::string label(const Document&, const SetQuality& command) {
    if (command.levels) return "Set levels of effects";
    return fmt::format("Set quality to {}", to_string(command.quality));
}
std::string label(const Document&, const SetCalibration& command) {
    return command.folder.empty() ? "Use no calibration"
                                  : fmt::format("Use calibration {}", short_name(command.folder));
}
std::string label(const Document&, const SetBench& command) {
    return fmt::format("Use bench {}", short_name(command.bench));
}
std::string label(const Document&, const SetDesignWhite& command) {
    return fmt::format("Set design white to {:.4g} %", command.percentile);
}
std::string label(const Document&, const SetGamutMapping& command) {
    return command.mapping == GamutMapping::preserve ? "Keep hues out of reach"
                                                     : "Clip colours out of reach";
}

}  // namespace

std::string label_of(const Document& before, const SessionCommand& command) {
    return std::visit([&](const auto& one) { return label(before, one); }, command);
}

std::optional<int> look_of(const Document& after, const SessionCommand& command) {
    return std::visit(
        [&](const auto& one) -> std::optional<int> {
            using Kind = std::decay_t<decltype(one)>;
            int id = 0;
            if constexpr (std::is_same_v<Kind, AddLook> || std::is_same_v<Kind, DuplicateLook>) {
                id = after.next_look_id - 1;
            } else if constexpr (requires { one.look; }) {
                id = one.look;
            }
            return find_look(after, id) ? std::optional(id) : std::nullopt;
        },
        command);
}

}  // namespace livery
