#include "session/fields_json.h"

#include <algorithm>

#include "core/json.h"

namespace livery {

namespace {

/// A sentence with what was expected behind a semicolon, as a mistake of the field.
[[noreturn]] void fail_with(const JsonReader& field, const std::string& problem) {
    static const std::string between = "; expected ";
    const auto at = problem.find(between);
    if (at == std::string::npos) field.fail(problem, "seats that can be");
    field.fail(problem.substr(0, at), problem.substr(at + between.size()));
}

}  // namespace

Json json_of(const EyeSeat& seat) {
    Json json = {{"seat", seat.number}, {"eye_mm", json_from(seat.eye_mm)}};
    if (!seat.counts) json["counts"] = false;
    return json;
}

Json json_of(const std::vector<EyeSeat>& seats) {
    Json json = Json::array();
    for (const EyeSeat& seat : seats) json.push_back(json_of(seat));
    return json;
}

Json json_of(const EyeChoice& choice) {
    switch (choice.source) {
        case EyeSource::seat:
            return {{"of", "seat"}, {"seat", choice.seat}};
        case EyeSource::mean:
            return {{"of", "mean"}};
        case EyeSource::by_hand:
            break;
    }
    return {{"of", "hand"}};
}

EyeSeat read_seat(const JsonReader& object) {
    object.allow_only({"seat", "eye_mm", "counts"});
    EyeSeat seat;
    seat.number = object["seat"].integer(1, kLargestSeatNumber);
    seat.eye_mm = vec3_within(object["eye_mm"], kFarthestEye_mm);
    if (object.has("counts")) seat.counts = object["counts"].boolean();
    return seat;
}

std::vector<EyeSeat> read_seats(const JsonReader& list) {
    std::vector<EyeSeat> seats;
    for (std::size_t k = 0; k < list.size(); ++k) {
        seats.push_back(read_seat(list.at(k)));
        if (const auto problem = seats_problem(seats)) fail_with(list.at(k), *problem);
    }
    std::sort(seats.begin(), seats.end(), [](const EyeSeat& a, const EyeSeat& b) {
        return a.number < b.number;
    });
    return seats;
}

EyeChoice read_eye_choice(const JsonReader& object) {
    object.allow_only({"of", "seat"});
    const auto source = static_cast<EyeSource>(object["of"].one_of({"hand", "seat", "mean"}));
    if (source != EyeSource::seat) {
        if (object.has("seat")) object["seat"].fail("a seat's number", "none beside this \"of\"");
        return {source, 0};
    }
    return {source, object["seat"].integer(1, kLargestSeatNumber)};
}

EyeChoice read_eye_choice(const JsonReader& object, const std::vector<EyeSeat>& seats) {
    const EyeChoice choice = read_eye_choice(object);
    if (const auto problem = choice_problem(seats, choice)) fail_with(object, *problem);
    return choice;
}

}  // namespace livery
