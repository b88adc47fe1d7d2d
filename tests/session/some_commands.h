// Commands for tests: one of each kind, and endless random ones.
#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "session/commands.h"

namespace livery::testing {

inline const Document& car() {
    static const Document document = new_document("car");
    return document;
}

/// As a program applies it that first reads the files of paints that it names.
inline Document applied_with_files(const Document& document, const SessionCommand& command) {
    auto library = read_paint_library(document.library, unread_files(document, command));
    return applied(in_library(document, std::move(library)), command);
}

inline Material some_paint() {
    Material paint;
    paint.name = "solid red";
    paint.family = "solid";
    paint.model = ReflectanceModel::clearcoat;
    paint.diffuse = {0.1, 1.0 / 3.0, 0.02};
    paint.alpha = {0.3, 0.21};
    paint.provenance = "größer, \"quoted\"";
    return paint;
}

inline Artwork some_artwork() {
    Artwork artwork;
    artwork.name = "Streifen \"quer\"";
    artwork.part = "body";
    artwork.paint = "solid red";
    artwork.size_mm = 1.0 / 3.0;
    artwork.share = 0.3;
    artwork.place.centre_mm = {1.5, 1e-3, -40.0};
    return artwork;
}

/// The car's document with a paint of its own, one look without lights, and two seats.
inline Document car_with_own_paint() {
    Material own = some_paint();
    own.name = "own paint";
    const Document seated =
        applied(car(), SetSeats{{{1, {-400.0, 480.0, 900.0}}, {7, {0.5, 480.0, 1000.0}, false}}});
    return applied(applied(seated, SetLights{3, {}}), EditPaint{4, "rims", own});
}

/// One of each kind, all of which car_with_own_paint() takes.
inline std::vector<SessionCommand> one_of_each(const std::string& calibration_folder) {
    Look look = car().looks[1].look;
    look.name = "Übernahme";
    const DirectionalLight light{{0.6, 0.8, 0.0}, {1.0, 0.1, 1e-300}, 0.05};
    return {SetPaint{1, "body", "solid red"},
            PaintProduct{2, "matte grey"},
            EditPaint{1, "rims", some_paint()},
            RenamePaint{"own paint", "Monza \"rosso\""},
            SetArtwork{1, {some_artwork(), Artwork{}}},
            AddLook{look, 2},
            AddLook{look},
            DuplicateLook{3},
            RenameLook{2, "nachtblau"},
            DeleteLook{4},
            MoveLook{1, 3},
            SetLights{2, {light}},
            SetEnvironment{2, {"assets/environments/studio.hdr", 0.1, 1.5}},
            SetEnvironment{2, {}},
            ShareLighting{3},
            SetEye{{-0.0, 1.0 / 3.0, 700.5}},
            SetExposure{0.1},
            SetQuality{Quality::high},
            SetCalibration{calibration_folder},
            SetBench{"hard"},
            SetDesignWhite{35.5},
            SetGamutMapping{GamutMapping::preserve},
            SetSeat{7, {1.0 / 3.0, 481.0, -1e-3}},
            SetSeat{12, {900.0, 480.0, 0.0}, false},
            RemoveSeat{7},
            SetSeats{{{1, {500.0, 2.0, 3.0}, false}, {3, {1.0, 2.0, 3.0}}}},
            UseEye{{EyeSource::mean, 0}},
            UseEye{{EyeSource::seat, 7}}};
}

template <typename Value>
const Value& pick(Random& random, const std::vector<Value>& list) {
    return list[random.below(static_cast<std::uint32_t>(list.size()))];
}

inline double number(Random& random, double low, double high) {
    return low + (high - low) * random.uniform();
}

inline DirectionalLight random_light(Random& random) {
    DirectionalLight light;
    light.direction = {random.normal(), random.normal(), random.normal()};
    for (int c = 0; c < 3; ++c) light.radiance_rec709[c] = number(random, 0.0, 2.0);
    light.angle_rad = number(random, 0.0, 0.2);
    return light;
}

inline Material random_paint(Random& random, const std::string& name) {
    Material paint;
    paint.name = name;
    paint.model = static_cast<ReflectanceModel>(random.below(3));
    for (int c = 0; c < 3; ++c) paint.diffuse[c] = number(random, 0.2, 0.3);
    paint.alpha = {number(random, 0.1, 0.5), number(random, 0.1, 0.5)};
    return paint;
}

/// Mostly one that the document takes; now and then one that it refuses.
inline SessionCommand random_command(Random& random, const Document& document) {
    static const std::vector<std::string> parts = {
        "*", "body", "glass", "rims", "tyres", "lights", "trim", "sails"};
    static const std::vector<std::string> paints = {
        "solid red", "Solid-Blue", "chrome trim", "matte_grey", "no such paint"};
    const auto& looks = document.looks;
    const auto& one = looks[random.below(static_cast<std::uint32_t>(looks.size()))];
    const int id = random.below(30) == 0 ? 9999 : one.id;
    const auto place = static_cast<int>(random.below(static_cast<std::uint32_t>(looks.size() + 1)));
    // Looks that are many are deleted rather than added to.
    const bool many = looks.size() > 8;
    switch (random.below(23)) {
        case 0:
        case 1:
        case 2:
        case 3:
            return SetPaint{id, pick(random, parts), pick(random, paints)};
        case 4:
            return PaintProduct{id, pick(random, paints)};
        case 5:
        case 6: {
            const std::string part = pick(random, parts);
            const auto worn = one.look.parts.find(part);
            const std::string name = worn == one.look.parts.end() ? "own paint" : worn->second;
            return EditPaint{id, part, random_paint(random, name)};
        }
        case 7:
            if (many) return DeleteLook{id};
            return AddLook{one.look, place - 1};
        case 8:
            if (many) return DeleteLook{id};
            return DuplicateLook{id};
        case 9:
            return RenameLook{id, "look " + std::to_string(random.below(20))};
        case 10:
        case 11:
            return DeleteLook{id};
        case 12:
            return MoveLook{id, place};
        case 13:
            return SetLights{id, {random_light(random), random_light(random)}};
        case 14:
            return SetEnvironment{id,
                                  {random.below(2) ? "assets/environments/overcast.hdr" : "",
                                   number(random, -4.0, 4.0),
                                   number(random, 0.0, 2.0)}};
        case 15:
            return ShareLighting{id};
        case 16:
            return SetEye{{number(random, -500, 500), number(random, 0, 500), random.normal()}};
        case 17:
            return SetExposure{number(random, -31.0, 31.0)};
        case 18:
            return SetQuality{static_cast<Quality>(random.below(4))};
        case 19: {
            Artwork artwork = some_artwork();
            artwork.part = pick(random, parts);
            artwork.paint = pick(random, paints);
            artwork.size_mm = number(random, -0.5, 9.0);
            std::vector<Artwork> list = one.look.artwork;
            if (list.size() > 3) list.clear();
            list.push_back(artwork);
            return SetArtwork{id, list};
        }
        case 20:
            if (document.paints.empty()) return RenamePaint{"no such paint", "other"};
            return RenamePaint{pick(random, document.paints).name,
                               "paint " + std::to_string(random.below(9))};
        case 21:
            return SetGamutMapping{static_cast<GamutMapping>(random.below(2))};
        default:
            return SetDesignWhite{number(random, 0.0, 105.0)};
    }
}

}  // namespace livery::testing
