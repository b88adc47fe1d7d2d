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
    if (state.ballot) {
        json["ballot"] = json_of(*state.ballot);
        json["receipt"] = state.receipt;
    }
    return dumped(json);
}

std::string problem_text(const std::string& problem) { return dumped({{"problem", problem}}); }

}  // namespace livery
