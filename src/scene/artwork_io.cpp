#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/json.h"
#include "scene/look_json.h"

namespace livery {

namespace {

template <typename Enumeration, std::size_t Count>
Enumeration read_name(const JsonReader& field, const std::array<const char*, Count>& names) {
    const std::string name = field.text();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        field.fail(field.found(), fmt::format("{}", fmt::join(names, ", ")));
    }
    return static_cast<Enumeration>(found - names.begin());
}

template <typename Enumeration, std::size_t Count>
const char* name_of(Enumeration value, const std::array<const char*, Count>& names) {
    return names[static_cast<std::size_t>(value)];
}

ArtworkPlace read_place(const JsonReader& field, ArtworkPlace place) {
    field.allow_only({"centre_mm", "direction", "up", "through"});
    if (field.has("centre_mm")) place.centre_mm = place_mm(field["centre_mm"]);
    if (field.has("direction"))
        place.direction = vec3_within(field["direction"], kLongestDirection);
    if (field.has("up")) place.up = vec3_within(field["up"], kLongestDirection);
    if (field.has("through")) place.through = field["through"].boolean();
    return place;
}

/// What this shape reads beside what all do.
std::set<std::string> own_fields(ArtworkShape shape) {
    switch (shape) {
        case ArtworkShape::half:
            return {"softness_mm"};
        case ArtworkShape::stripes:
        case ArtworkShape::dots:
            return {"size_mm", "share"};
        case ArtworkShape::checks:
            return {"size_mm"};
        case ArtworkShape::picture:
            return {"size_mm", "picture", "use", "repeat", "depth"};
    }
    return {};
}

Artwork read_one(const JsonReader& field) {
    Artwork artwork;
    artwork.shape = read_name<ArtworkShape>(field["shape"], kArtworkShapes);
    const bool picture = artwork.shape == ArtworkShape::picture;
    const std::set<std::string> own = own_fields(artwork.shape);
    for (const std::string& key : field.keys()) {
        const bool common =
            key == "name" || key == "part" || key == "paint" || key == "shape" || key == "place";
        if (common || own.contains(key)) continue;
        std::string fields = "name, part, paint, shape, place";
        for (const std::string& one : own) fields += ", " + one;
        field[key].fail(fmt::format("a field that {} do not have",
                                    picture ? "pictures" : name_of(artwork.shape, kArtworkShapes)),
                        fields);
    }
    if (field.has("name")) artwork.name = field["name"].text();
    if (field.has("part")) artwork.part = field["part"].text();
    if (field.has("paint")) artwork.paint = field["paint"].text();
    if (field.has("size_mm")) artwork.size_mm = field["size_mm"].number();
    if (field.has("share")) artwork.share = field["share"].number();
    if (field.has("softness_mm")) artwork.softness_mm = field["softness_mm"].number();
    if (picture) artwork.picture = field["picture"].text();
    if (field.has("use")) artwork.use = read_name<PictureUse>(field["use"], kPictureUses);
    if (field.has("depth")) artwork.depth = field["depth"].number();
    if (field.has("repeat")) artwork.repeat = field["repeat"].boolean();
    artwork.place.through = !picture;
    if (field.has("place")) {
        const JsonReader place = field["place"];
        if (place.is_text()) {
            if (place.text() != "uv") place.fail(place.found(), "\"uv\" or an object");
            artwork.place.by_uv = true;
        } else {
            artwork.place = read_place(place, artwork.place);
        }
    }
    try {
        check_artwork(artwork);
    } catch (const std::invalid_argument& error) {
        field.fail(error.what(), "an artwork");
    }
    return artwork;
}

Json json_of(const Artwork& artwork) {
    Json json = Json::object();
    if (!artwork.name.empty()) json["name"] = artwork.name;
    json["part"] = artwork.part;
    if (!artwork.paint.empty()) json["paint"] = artwork.paint;
    json["shape"] = name_of(artwork.shape, kArtworkShapes);
    const std::set<std::string> own = own_fields(artwork.shape);
    if (own.contains("picture")) json["picture"] = artwork.picture;
    if (own.contains("use")) json["use"] = name_of(artwork.use, kPictureUses);
    if (own.contains("size_mm")) json["size_mm"] = artwork.size_mm;
    if (own.contains("share")) json["share"] = artwork.share;
    if (own.contains("softness_mm")) json["softness_mm"] = artwork.softness_mm;
    if (own.contains("repeat")) json["repeat"] = artwork.repeat;
    if (is_relief(artwork)) json["depth"] = artwork.depth;
    const ArtworkPlace& place = artwork.place;
    if (place.by_uv) {
        json["place"] = "uv";
    } else {
        json["place"] = {{"centre_mm", json_from(place.centre_mm)},
                         {"direction", json_from(place.direction)},
                         {"up", json_from(place.up)},
                         {"through", place.through}};
    }
    return json;
}

}  // namespace

std::vector<Artwork> read_artwork(const JsonReader& list) {
    std::vector<Artwork> artwork;
    if (list.size() > kMostArtworks) {
        list.fail(fmt::format("{} artworks", list.size()),
                  fmt::format("at most {}", kMostArtworks));
    }
    for (std::size_t k = 0; k < list.size(); ++k) artwork.push_back(read_one(list.at(k)));
    return artwork;
}

Json json_of(const std::vector<Artwork>& artwork) {
    Json json = Json::array();
    for (const Artwork& one : artwork) json.push_back(json_of(one));
    return json;
}

}  // namespace livery
