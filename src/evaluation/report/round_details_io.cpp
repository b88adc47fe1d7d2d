#include <algorithm>
#include <system_error>

#include "core/error.h"
#include "core/json.h"
#include "core/paths.h"
#include "core/utf8.h"
#include "evaluation/report/round_details.h"

namespace livery {

namespace {

// 2 may have the eye; details without are written as before there was one.
constexpr int kFormatVersion = 2, kWithoutEye = 1;
constexpr std::size_t kMostBytes = 4u << 20u;
constexpr int kMostSeat = 1'000'000;
/// One line, of what people read.
std::string line_of(const JsonReader& object, const char* key) {
    if (!object.has(key)) return "";
    const std::string text = object[key].text();
    if (text != printable(text, 2000)) {
        object[key].fail("\"" + printable(text, 40) + "\"", "one line of at most 2000 characters");
    }
    return text;
}

int code_of(const JsonReader& value, const std::vector<int>& codes) {
    const int code = value.integer(100, 999);
    if (std::find(codes.begin(), codes.end(), code) == codes.end()) {
        std::vector<std::string> all;
        for (const int known : codes) all.push_back(std::to_string(known));
        value.fail(std::to_string(code), "one of the round's codes " + list_of(all));
    }
    return code;
}

std::optional<double> optional_number(const JsonReader& object,
                                      const char* key,
                                      double low,
                                      double high) {
    if (!object.has(key)) return std::nullopt;
    return object[key].number_between(low, high);
}

LookReachability reachability_of(const JsonReader& object) {
    object.allow_only({"reachable_fraction", "de00_median", "de00_p95"});
    constexpr double most_difference = 1000.0;
    return {optional_number(object, "reachable_fraction", 0.0, 1.0),
            optional_number(object, "de00_median", 0.0, most_difference),
            optional_number(object, "de00_p95", 0.0, most_difference)};
}

std::string picture_of(const JsonReader& object) {
    if (!object.has("picture")) return "";
    const std::string name = object["picture"].text();
    // A file in the same folder and nothing else: such a folder is handed from one to another.
    if (name.empty() || name.starts_with('.') || name.find('/') != std::string::npos ||
        name != printable(name, 255)) {
        object["picture"].fail("\"" + printable(name, 40) + "\"",
                               "the name of a picture in the same folder");
    }
    return name;
}

LookDetails look_of(const JsonReader& object, const std::vector<int>& codes) {
    object.allow_only({"code", "picture", "reachability"});
    LookDetails look{code_of(object["code"], codes), picture_of(object)};
    if (object.has("reachability")) look.reachability = reachability_of(object["reachability"]);
    return look;
}

LookShowing showing_of(const JsonReader& object, const std::vector<int>& codes) {
    object.allow_only({"at", "seats", "codes"});
    LookShowing showing;
    showing.at = line_of(object, "at");
    if (object.has("seats")) {
        const JsonReader seats = object["seats"];
        for (std::size_t k = 0; k < seats.size(); ++k) {
            showing.seats.push_back(seats.at(k).integer(1, kMostSeat));
        }
    }
    const JsonReader order = object["codes"];
    for (std::size_t k = 0; k < order.size(); ++k) {
        showing.codes.push_back(code_of(order.at(k), codes));
    }
    return showing;
}

constexpr double kMostDifference = 1e4, kFarthestEye_mm = 1e6;
constexpr int kLargestSeatNumber = 999;
constexpr std::size_t kLongestWords = 200;

SeatMiss read_miss(const JsonReader& object, const std::vector<int>& codes) {
    object.allow_only({"code", "de00_median", "de00_p95", "share_over_3"});
    SeatMiss miss;
    miss.code = code_of(object["code"], codes);
    miss.de00_median = object["de00_median"].number_between(0.0, kMostDifference);
    miss.de00_p95 = object["de00_p95"].number_between(0.0, kMostDifference);
    miss.share_over_3 = object["share_over_3"].number_between(0.0, 1.0);
    return miss;
}

RoundSeat read_round_seat(const JsonReader& object, const std::vector<int>& codes) {
    object.allow_only({"seat", "eye_mm", "counts", "looks"});
    RoundSeat seat;
    seat.seat = object["seat"].integer(1, kLargestSeatNumber);
    seat.eye_mm = vec3_within(object["eye_mm"], kFarthestEye_mm);
    if (object.has("counts")) seat.counts = object["counts"].boolean();
    if (!object.has("looks")) return seat;
    const JsonReader looks = object["looks"];
    for (std::size_t k = 0; k < looks.size(); ++k) {
        const SeatMiss miss = read_miss(looks.at(k), codes);
        for (const SeatMiss& other : seat.looks) {
            if (other.code != miss.code) continue;
            looks.at(k)["code"].fail(std::to_string(miss.code) + " for a second time",
                                     "each look once");
        }
        seat.looks.push_back(miss);
    }
    return seat;
}

Json json_of(const RoundEye& eye) {
    Json json = {{"of", eye.of}, {"eye_mm", json_from(eye.eye_mm)}, {"seats", Json::array()}};
    for (const RoundSeat& seat : eye.seats) {
        Json entry = {{"seat", seat.seat}, {"eye_mm", json_from(seat.eye_mm)}};
        if (!seat.counts) entry["counts"] = false;
        for (const SeatMiss& miss : seat.looks) {
            entry["looks"].push_back({{"code", miss.code},
                                      {"de00_median", miss.de00_median},
                                      {"de00_p95", miss.de00_p95},
                                      {"share_over_3", miss.share_over_3}});
        }
        json["seats"].push_back(std::move(entry));
    }
    return json;
}

RoundEye read_round_eye(const JsonReader& object, const std::vector<int>& codes) {
    object.allow_only({"of", "eye_mm", "seats"});
    RoundEye eye;
    eye.of = object["of"].text();
    if (eye.of != printable(eye.of, kLongestWords)) {
        object["of"].fail("\"" + printable(eye.of, 40) + "\"",
                          "one line of at most " + std::to_string(kLongestWords) + " characters");
    }
    eye.eye_mm = vec3_within(object["eye_mm"], kFarthestEye_mm);
    const JsonReader seats = object["seats"];
    for (std::size_t k = 0; k < seats.size(); ++k) {
        RoundSeat seat = read_round_seat(seats.at(k), codes);
        for (const RoundSeat& other : eye.seats) {
            if (other.seat != seat.seat) continue;
            seats.at(k)["seat"].fail(std::to_string(seat.seat) + " for a second time",
                                     "each number once");
        }
        eye.seats.push_back(std::move(seat));
    }
    return eye;
}

}  // namespace

RoundDetails parse_round_details(const std::string& text,
                                 const std::filesystem::path& file,
                                 int round,
                                 const std::vector<int>& codes) {
    const Json json = parse_json(text, file);
    const JsonReader object(file, json);
    object.require_format_version(kFormatVersion);
    object.allow_only({"format_version",
                       "kind",
                       "round",
                       "title",
                       "question",
                       "note",
                       "looks",
                       "showings",
                       "eye"});
    object["kind"].one_of({"round-details"});
    if (object["round"].integer(1, 1'000'000'000) != round) {
        object["round"].fail(object["round"].found(), "round " + std::to_string(round));
    }
    RoundDetails details;
    details.folder = file.parent_path();
    details.title = line_of(object, "title");
    details.question = line_of(object, "question");
    details.note = line_of(object, "note");
    if (object.has("looks")) {
        const JsonReader looks = object["looks"];
        for (std::size_t k = 0; k < looks.size(); ++k) {
            LookDetails look = look_of(looks.at(k), codes);
            const bool twice = std::any_of(
                details.looks.begin(), details.looks.end(), [&](const LookDetails& other) {
                    return other.code == look.code;
                });
            if (twice) looks.at(k)["code"].fail(std::to_string(look.code), "each look once");
            details.looks.push_back(std::move(look));
        }
    }
    if (object.has("showings")) {
        const JsonReader showings = object["showings"];
        for (std::size_t k = 0; k < showings.size(); ++k) {
            details.showings.push_back(showing_of(showings.at(k), codes));
        }
    }
    if (object.has("eye")) details.eye = read_round_eye(object["eye"], codes);
    return details;
}

void write_round_details(const std::filesystem::path& file,
                         int round,
                         const RoundDetails& details) {
    const int version = details.eye ? kFormatVersion : kWithoutEye;
    Json json = {{"format_version", version}, {"kind", "round-details"}, {"round", round}};
    for (const auto& [key, text] : {std::pair{"title", &details.title},
                                    {"question", &details.question},
                                    {"note", &details.note}}) {
        if (!text->empty()) json[key] = *text;
    }
    for (const LookDetails& look : details.looks) {
        Json entry = {{"code", look.code}};
        if (!look.picture.empty()) entry["picture"] = look.picture;
        if (look.reachability) {
            Json& reach = entry["reachability"] = Json::object();
            const auto put = [&](const char* key, const std::optional<double>& value) {
                if (value) reach[key] = *value;
            };
            put("reachable_fraction", look.reachability->reachable_fraction);
            put("de00_median", look.reachability->de00_median);
            put("de00_p95", look.reachability->de00_p95);
        }
        json["looks"].push_back(std::move(entry));
    }
    for (const LookShowing& showing : details.showings) {
        Json entry = {{"at", showing.at}, {"codes", showing.codes}};
        if (!showing.seats.empty()) entry["seats"] = showing.seats;
        json["showings"].push_back(std::move(entry));
    }
    if (details.eye) json["eye"] = json_of(*details.eye);
    make_output_folder(file.parent_path());
    write_json_file(file, json);
}

std::filesystem::path round_details_file(const std::filesystem::path& ballots, int round) {
    return ballots.parent_path() / (ballots.stem().string() + "-round-" + std::to_string(round)) /
           "round.json";
}

RoundDetails read_round_details(const std::filesystem::path& file,
                                int round,
                                const std::vector<int>& codes) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return {};
    return parse_round_details(read_text_file(file, kMostBytes), file, round, codes);
}

}  // namespace livery
