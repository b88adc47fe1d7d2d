#include <array>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "appearance/material_json.h"
#include "core/error.h"
#include "core/json.h"
#include "scene/look_json.h"
#include "session/commands.h"
#include "session/fields_json.h"

namespace livery {

namespace {

int look_in(const JsonReader& fields) {
    return fields["look"].integer(1, std::numeric_limits<int>::max());
}

Json fields_of(const SetPaint& c) {
    Json json = {{"look", c.look}, {"part", c.part}, {"paint", c.paint}};
    if (!c.look_name.empty()) json["look_name"] = c.look_name;
    return json;
}
void read(const JsonReader& fields, SetPaint& c) {
    fields.allow_only({"look", "part", "paint", "look_name"});
    c = {look_in(fields), fields["part"].text(), fields["paint"].text()};
    if (fields.has("look_name")) c.look_name = fields["look_name"].text();
}

Json fields_of(const PaintProduct& c) {
    Json json = {{"look", c.look}, {"paint", c.paint}};
    if (!c.look_name.empty()) json["look_name"] = c.look_name;
    return json;
}
void read(const JsonReader& fields, PaintProduct& c) {
    fields.allow_only({"look", "paint", "look_name"});
    c = {look_in(fields), fields["paint"].text()};
    if (fields.has("look_name")) c.look_name = fields["look_name"].text();
}

Json fields_of(const EditPaint& c) {
    return {{"look", c.look}, {"part", c.part}, {"material", json_of(c.material)}};
}
void read(const JsonReader& fields, EditPaint& c) {
    fields.allow_only({"look", "part", "material"});
    const JsonReader material = fields["material"];
    material.allow_only({"name", "family", "model", "parameters", "provenance"});
    c = {look_in(fields), fields["part"].text(), read_material(material)};
}

Json fields_of(const RenamePaint& c) { return {{"paint", c.paint}, {"name", c.name}}; }
void read(const JsonReader& fields, RenamePaint& c) {
    fields.allow_only({"paint", "name"});
    c = {fields["paint"].text(), fields["name"].text()};
}

Json fields_of(const SetArtwork& c) { return {{"look", c.look}, {"artwork", json_of(c.artwork)}}; }
void read(const JsonReader& fields, SetArtwork& c) {
    fields.allow_only({"look", "artwork"});
    c = {look_in(fields), read_artwork(fields["artwork"])};
}

Json fields_of(const AddLook& c) {
    Json json = {{"look", json_of(portable_look(c.look))}};
    json["look"].erase("exposure_ev");
    if (c.at >= 0) json["at"] = c.at;
    return json;
}
void read(const JsonReader& fields, AddLook& c) {
    fields.allow_only({"look", "at"});
    const JsonReader look = fields["look"];
    look.allow_only({"name", "parts", "variant", "artwork", "lights", "environment"});
    look["name"].text();
    c.look = read_look(look);
    if (fields.has("at")) c.at = fields["at"].integer(0, std::numeric_limits<int>::max());
}

Json fields_of(const DuplicateLook& c) { return {{"look", c.look}}; }
void read(const JsonReader& fields, DuplicateLook& c) {
    fields.allow_only({"look"});
    c.look = look_in(fields);
}

Json fields_of(const RenameLook& c) { return {{"look", c.look}, {"name", c.name}}; }
void read(const JsonReader& fields, RenameLook& c) {
    fields.allow_only({"look", "name"});
    c = {look_in(fields), fields["name"].text()};
}

Json fields_of(const DeleteLook& c) { return {{"look", c.look}}; }
void read(const JsonReader& fields, DeleteLook& c) {
    fields.allow_only({"look"});
    c.look = look_in(fields);
}

Json fields_of(const MoveLook& c) { return {{"look", c.look}, {"to", c.to}}; }
void read(const JsonReader& fields, MoveLook& c) {
    fields.allow_only({"look", "to"});
    c = {look_in(fields), fields["to"].integer(0, std::numeric_limits<int>::max())};
}

Json fields_of(const SetLights& c) { return {{"look", c.look}, {"lights", json_of(c.lights)}}; }
void read(const JsonReader& fields, SetLights& c) {
    fields.allow_only({"look", "lights"});
    c = {look_in(fields), read_lights(fields["lights"])};
}

Json fields_of(const SetEnvironment& c) {
    Json json = {{"look", c.look}};
    if (!c.environment.file.empty()) json["environment"] = json_of(c.environment);
    return json;
}
void read(const JsonReader& fields, SetEnvironment& c) {
    fields.allow_only({"look", "environment"});
    c = {look_in(fields), read_environment(fields)};
}

Json fields_of(const ShareLighting& c) { return {{"look", c.look}}; }
void read(const JsonReader& fields, ShareLighting& c) {
    fields.allow_only({"look"});
    c.look = look_in(fields);
}

Json fields_of(const SetEye& c) { return {{"eye_mm", json_from(c.eye_mm)}}; }
void read(const JsonReader& fields, SetEye& c) {
    fields.allow_only({"eye_mm"});
    c.eye_mm = place_mm(fields["eye_mm"]);
}

Json fields_of(const SetSeat& c) { return json_of(EyeSeat{c.seat, c.eye_mm, c.counts}); }
void read(const JsonReader& fields, SetSeat& c) {
    const EyeSeat seat = read_seat(fields);
    c = {seat.number, seat.eye_mm, seat.counts};
}

Json fields_of(const RemoveSeat& c) { return {{"seat", c.seat}}; }
void read(const JsonReader& fields, RemoveSeat& c) {
    fields.allow_only({"seat"});
    c.seat = fields["seat"].integer(1, kLargestSeatNumber);
}

Json fields_of(const SetSeats& c) { return {{"seats", json_of(c.seats)}}; }
void read(const JsonReader& fields, SetSeats& c) {
    fields.allow_only({"seats"});
    c.seats = read_seats(fields["seats"]);
}

Json fields_of(const UseEye& c) { return json_of(c.choice); }
void read(const JsonReader& fields, UseEye& c) { c.choice = read_eye_choice(fields); }

Json fields_of(const SetExposure& c) { return {{"ev", c.ev}}; }
void read(const JsonReader& fields, SetExposure& c) {
    fields.allow_only({"ev"});
    c.ev = fields["ev"].number();
}

Json fields_of(const SetQuality& c) {
    Json json = {{"quality", to_string(c.quality)}};
    if (c.levels) json["levels"] = to_string(*c.levels);
    return json;
}
void read(const JsonReader& fields, SetQuality& c) {
    fields.allow_only({"quality", "levels"});
    c.quality = read_quality(fields["quality"]);
    if (fields.has("levels")) c.levels = read_levels(fields["levels"]);
}

Json fields_of(const SetCalibration& c) { return {{"folder", c.folder}}; }
void read(const JsonReader& fields, SetCalibration& c) {
    fields.allow_only({"folder"});
    c.folder = fields["folder"].text();
}

Json fields_of(const SetBench& c) { return {{"bench", c.bench}}; }
void read(const JsonReader& fields, SetBench& c) {
    fields.allow_only({"bench"});
    c.bench = fields["bench"].text();
}

Json fields_of(const SetDesignWhite& c) { return {{"percentile", c.percentile}}; }
void read(const JsonReader& fields, SetDesignWhite& c) {
    fields.allow_only({"percentile"});
    c.percentile = fields["percentile"].number();
}

Json fields_of(const SetGamutMapping& c) { return {{"mapping", to_string(c.mapping)}}; }
void read(const JsonReader& fields, SetGamutMapping& c) {
    fields.allow_only({"mapping"});
    c.mapping = read_gamut_mapping(fields["mapping"]);
}

/// In the order of SessionCommand's alternatives.
constexpr std::array<const char*, std::variant_size_v<SessionCommand>> kNames = {
    "set-paint",   "paint-product",   "edit-paint",     "rename-paint",     "set-artwork",
    "add-look",    "duplicate-look",  "rename-look",    "delete-look",      "move-look",
    "set-lights",  "set-environment", "share-lighting", "set-eye",          "set-exposure",
    "set-quality", "set-calibration", "set-bench",      "set-design-white", "set-gamut-mapping",
    "set-seat",    "remove-seat",     "set-seats",      "use-eye"};

template <std::size_t K = 0>
SessionCommand read_kind(const std::string& name, const JsonReader& root) {
    if constexpr (K < kNames.size()) {
        if (name != kNames[K]) return read_kind<K + 1>(name, root);
        const JsonReader fields = root[name];
        if (!fields.is_object()) fields.fail(fields.found(), "an object");
        std::variant_alternative_t<K, SessionCommand> command;
        read(fields, command);
        return command;
    } else {
        root.fail(fmt::format("the command \"{}\"", name),
                  fmt::format("one of {}", fmt::join(kNames, ", ")));
    }
}

}  // namespace

std::string text_of(const SessionCommand& command) {
    Json json = Json::object();
    json[kNames[command.index()]] = std::visit([](const auto& c) { return fields_of(c); }, command);
    try {
        return json.dump();
    } catch (const Json::exception&) {
        throw std::invalid_argument(std::string(kNames[command.index()]) +
                                    " has a text that is not UTF-8");
    }
}

SessionCommand parse_session_command(const std::string& text, const std::string& origin) {
    const Json json = parse_json(text, origin);
    const JsonReader root(origin, json);
    const auto names = root.keys();
    if (names.size() != 1) {
        root.fail(std::to_string(names.size()) + " members", "one: the command's name");
    }
    return read_kind(names.front(), root);
}

}  // namespace livery
