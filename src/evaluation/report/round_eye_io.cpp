#include <algorithm>
#include <string>

#include "core/json.h"
#include "core/paths.h"
#include "core/utf8.h"
#include "evaluation/report/round_eye_json.h"

namespace livery {

namespace {

constexpr double kMostDifference = 1e4, kFarthestEye_mm = 1e6;
constexpr int kLargestSeatNumber = 999;
constexpr std::size_t kLongestWords = 200;

SeatMiss read_miss(const JsonReader& object, const std::vector<int>& codes) {
    object.allow_only({"code", "de00_median", "de00_p95", "share_over_3"});
    SeatMiss miss;
    miss.code = object["code"].integer(100, 999);
    if (std::find(codes.begin(), codes.end(), miss.code) == codes.end()) {
        object["code"].fail(std::to_string(miss.code), "one of the round's codes");
    }
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

}  // namespace

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

}  // namespace livery
