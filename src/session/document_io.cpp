#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "appearance/material_json.h"
#include "core/error.h"
#include "core/json.h"
#include "scene/look_json.h"
#include "session/document.h"
#include "session/fields_json.h"
#include "session/naming.h"
#include "session/paint_edit.h"

namespace livery {

namespace {

// 2 has seats. What has none is written as before, for programs from before there were any.
constexpr int kDocumentVersion = 2, kWithoutSeats = 1;
constexpr int kLargestId = std::numeric_limits<int>::max() - 1;

/// A text that can be shown; a mistake is told of its field.
std::string checked_text(const JsonReader& field) {
    const std::string text = field.text();
    try {
        check_text(text, "the text");
    } catch (const std::invalid_argument& mistake) {
        field.fail(mistake.what(), "a text that can be shown");
    }
    return text;
}

SessionLook read_session_look(const JsonReader& object) {
    object.allow_only({"id", "name", "parts", "variant", "artwork", "lights", "environment"});
    SessionLook look;
    look.id = object["id"].integer(1, kLargestId);
    look.look = read_look(object);
    look.look.name = checked_text(object["name"]);
    return look;
}

Json json_of(const SessionLook& look) {
    Json json = Json::object();
    json["id"] = look.id;
    json.update(json_of(look.look));
    json.erase("exposure_ev");
    return json;
}

void read_looks(const JsonReader& list, Document& document) {
    for (std::size_t k = 0; k < list.size(); ++k) {
        const JsonReader field = list.at(k);
        SessionLook look = read_session_look(field);
        for (const SessionLook& other : document.looks) {
            if (other.id == look.id) {
                field["id"].fail(field["id"].found() + " for a second time", "each number once");
            }
            if (other.look.name == look.look.name) {
                field["name"].fail(field["name"].found() + " for a second time", "each name once");
            }
        }
        document.looks.push_back(std::move(look));
    }
    if (document.looks.empty()) list.fail("no look", "at least one");
}

void read_paints(const JsonReader& list, Document& document) {
    for (std::size_t k = 0; k < list.size(); ++k) {
        const JsonReader field = list.at(k);
        field.allow_only({"name", "family", "model", "parameters", "provenance"});
        Material paint = read_material(field);
        paint.name = checked_text(field["name"]);
        for (const Material& other : document.paints) {
            if (other.name == paint.name) {
                field["name"].fail(field["name"].found() + " for a second time", "each name once");
            }
        }
        document.paints.push_back(std::move(paint));
    }
}

Json json_of(const Document& document) {
    Json json = Json::object();
    const bool seats = !document.seats.empty() || document.eye_choice != EyeChoice{};
    json["format_version"] = seats ? kDocumentVersion : kWithoutSeats;
    json["product"] = document.product;
    if (document.product_unit) json["product_unit"] = to_string(*document.product_unit);
    json["looks"] = Json::array();
    for (const SessionLook& look : document.looks) json["looks"].push_back(json_of(look));
    json["next_look_id"] = document.next_look_id;
    json["paints"] = Json::array();
    for (const Material& paint : document.paints) json["paints"].push_back(json_of(paint));
    json["eye_mm"] = json_from(document.eye_mm);
    if (seats) {
        json["seats"] = json_of(document.seats);
        json["eye_of"] = json_of(document.eye_choice);
    }
    json["exposure_ev"] = document.exposure_ev;
    json["quality"] = to_string(document.quality);
    if (document.levels) json["levels"] = to_string(*document.levels);
    json["bench"] = document.bench;
    json["calibration"] = document.calibration;
    json["design_white_percentile"] = document.design_white_percentile;
    json["gamut_mapping"] = to_string(document.gamut_mapping);
    return json;
}

Document read_document(const JsonReader& root) {
    root.require_format_version(kDocumentVersion);
    root.allow_only({"format_version",
                     "product",
                     "product_unit",
                     "looks",
                     "next_look_id",
                     "paints",
                     "eye_mm",
                     "seats",
                     "eye_of",
                     "exposure_ev",
                     "quality",
                     "levels",
                     "bench",
                     "calibration",
                     "design_white_percentile",
                     "gamut_mapping"});
    Document document;
    document.product = checked_text(root["product"]);
    if (root.has("product_unit")) {
        const JsonReader unit = root["product_unit"];
        document.product_unit = parse_length_unit(unit.text());
        if (!document.product_unit) unit.fail(unit.found(), "mm, cm, m or in");
    }
    read_looks(root["looks"], document);
    document.next_look_id = root["next_look_id"].integer(1, kLargestId);
    for (const SessionLook& look : document.looks) {
        if (look.id >= document.next_look_id) {
            root["next_look_id"].fail(
                root["next_look_id"].found(),
                "more than the looks' numbers (" + std::to_string(look.id) + " is one)");
        }
    }
    read_paints(root["paints"], document);
    document.eye_mm = place_mm(root["eye_mm"]);
    if (root.has("seats")) document.seats = read_seats(root["seats"]);
    if (root.has("eye_of")) {
        document.eye_choice = read_eye_choice(root["eye_of"], document.seats);
    }
    document.exposure_ev = root["exposure_ev"].number_between(-30.0, 30.0);
    document.quality = read_quality(root["quality"]);
    if (root.has("levels")) document.levels = read_levels(root["levels"]);
    document.bench = checked_text(root["bench"]);
    document.calibration = checked_text(root["calibration"]);
    document.design_white_percentile = root["design_white_percentile"].number_between(0.0, 100.0);
    // Sessions from before there was a choice were shown without mapping.
    if (root.has("gamut_mapping")) {
        document.gamut_mapping = read_gamut_mapping(root["gamut_mapping"]);
    }
    return document;
}

}  // namespace

Material kept_paint(const Material& paint) {
    try {
        const Json json = json_of(paint);
        Material kept = read_material(JsonReader("", json));
        kept.file = paint.file;
        kept.measured = paint.measured;
        return kept;
    } catch (const FileError& mistake) {
        throw std::invalid_argument(mistake.field() + " is " + mistake.found() + "; expected " +
                                    mistake.expected());
    } catch (const Json::exception&) {
        throw std::invalid_argument("the paint has a text that is not UTF-8");
    }
}

std::string text_of(const Document& document) { return json_of(document).dump(); }

Document parse_document(const std::string& text, const std::filesystem::path& origin) {
    const Json json = parse_json(text, origin);
    return read_document(JsonReader(origin, json));
}

}  // namespace livery
