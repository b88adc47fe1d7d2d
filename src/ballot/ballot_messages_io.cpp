#include "ballot/ballot_messages_io.h"

#include "core/json.h"

namespace livery {

namespace {

constexpr int kMostRounds = 1'000'000;

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

int code_in(const JsonReader& reader, std::string_view field) {
    return reader[field].integer(100, 999);
}

bool has_value(const Json& json, const char* field) {
    return json.contains(field) && !json[field].is_null();
}

Json json_of(const VoteMessage& vote) {
    return {{"round", vote.round},
            {"best", vote.best},
            {"second", vote.second},
            {"least", vote.least ? Json(*vote.least) : Json(nullptr)}};
}

}  // namespace

VoteMessage parse_vote(const std::string& body) {
    const Json json = parse_json(body, "ballot");
    const JsonReader reader("ballot", json);
    reader.allow_only({"round", "best", "second", "least"});
    VoteMessage vote;
    vote.round = reader["round"].integer(1, kMostRounds);
    vote.best = code_in(reader, "best");
    vote.second = code_in(reader, "second");
    if (has_value(json, "least")) vote.least = code_in(reader, "least");
    return vote;
}

RatingMessage parse_rating(const std::string& body) {
    const Json json = parse_json(body, "answers");
    const JsonReader reader("answers", json);
    reader.allow_only({"round", "look", "steps"});
    RatingMessage rating;
    rating.round = reader["round"].integer(1, kMostRounds);
    rating.look = code_in(reader, "look");
    const JsonReader steps = reader["steps"];
    const std::size_t count = steps.size();
    if (count == 0 || count > kMostScales) {
        steps.fail(std::to_string(count) + " steps", "1 to " + std::to_string(kMostScales));
    }
    for (std::size_t k = 0; k < count; ++k) {
        auto& step = rating.steps.emplace_back();
        if (!json["steps"][k].is_null()) step = steps.at(k).integer(1, kScaleSteps);
    }
    return rating;
}

std::string parse_join(const std::string& body) {
    const Json json = parse_json(body, "joining");
    const JsonReader reader("joining", json);
    reader.allow_only({"code"});
    return reader["code"].text();
}

std::string text_of(const PageState& state) {
    Json json = {{"state", state.state}, {"seat", state.seat}, {"round", state.round}};
    if (state.wave > 0) {
        json["wave"] = state.wave;
        json["waves"] = state.waves;
    }
    if (!state.codes.empty()) {
        json["codes"] = state.codes;
        json["least"] = state.asks_least;
    }
    if (!state.scales.empty()) {
        json["scales"] = Json::array();
        for (const SemanticScale& scale : state.scales) {
            json["scales"].push_back({scale.low, scale.high});
        }
        json["ratings"] = Json::object();
        for (const auto& [look, steps] : state.ratings) {
            Json& placed = json["ratings"][std::to_string(look)] = Json::array();
            for (const auto& step : steps) placed.push_back(step ? Json(*step) : Json(nullptr));
        }
    }
    if (state.ballot) {
        json["ballot"] = json_of(*state.ballot);
        json["receipt"] = state.receipt;
    }
    return dumped(json);
}

std::string problem_text(const std::string& problem) { return dumped({{"problem", problem}}); }

}  // namespace livery
