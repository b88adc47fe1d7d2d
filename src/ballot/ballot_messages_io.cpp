#include "ballot/ballot_messages_io.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/json.h"

namespace livery {

namespace {

constexpr int kMostRounds = 1'000'000;

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool has_value(const Json& json, const char* field) {
    return json.contains(field) && !json[field].is_null();
}

const Round& round_under_vote(const JsonReader& reader, const std::optional<Round>& round) {
    const int id = reader["round"].integer(1, kMostRounds);
    if (!round || round->id != id) {
        throw Refused(round_name(id) + " is not the one under vote", "look at the page again");
    }
    return *round;
}

/// The look that the field's code stands for.
int look_in(const JsonReader& reader, std::string_view field, const Round& round) {
    const int code = reader[field].integer(100, 999);
    const auto found = std::find(round.codes.begin(), round.codes.end(), code);
    if (found == round.codes.end()) {
        reader[field].fail("look " + std::to_string(code), "one of the round's");
    }
    return static_cast<int>(found - round.codes.begin());
}

}  // namespace

Ballot parse_vote(const std::string& body, const std::optional<Round>& under_vote) {
    const Json json = parse_json(body, "ballot");
    const JsonReader reader("ballot", json);
    reader.allow_only({"round", "best", "second", "least"});
    const Round& round = round_under_vote(reader, under_vote);
    Ballot ballot{look_in(reader, "best", round), look_in(reader, "second", round)};
    if (has_value(json, "least")) ballot.least = look_in(reader, "least", round);
    return ballot;
}

RatingMessage parse_rating(const std::string& body, const std::optional<Round>& under_vote) {
    const Json json = parse_json(body, "answers");
    const JsonReader reader("answers", json);
    reader.allow_only({"round", "look", "steps"});
    RatingMessage rating;
    rating.design = look_in(reader, "look", round_under_vote(reader, under_vote));
    const JsonReader steps = reader["steps"];
    const std::size_t count = steps.size();
    if (count == 0 || count > kMostScales) {
        steps.fail(std::to_string(count) + " steps", "1 to " + std::to_string(kMostScales));
    }
    for (std::size_t k = 0; k < count; ++k) {
        rating.steps.push_back(json["steps"][k].is_null() ? 0
                                                          : steps.at(k).integer(1, kScaleSteps));
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
    const Round round = state.round.value_or(Round());
    const auto code = [&](int design) -> Json {
        if (design < 0) return nullptr;
        return round.codes.at(static_cast<std::size_t>(design));
    };
    Json json = {{"state", state.state}, {"seat", state.seat}, {"round", round.id}};
    if (state.wave > 0) {
        json["wave"] = state.wave;
        json["waves"] = state.waves;
    }
    if (state.votes && !round.closed()) {
        // Their order says nothing: codes are random.
        std::vector<int> codes = round.codes;
        std::sort(codes.begin(), codes.end());
        json["codes"] = codes;
        json["least"] = round.asks_least;
        if (!round.scales.empty()) json["ratings"] = Json::object();
        for (const SemanticScale& scale : round.scales) {
            json["scales"].push_back({scale.low, scale.high});
        }
        for (std::size_t k = 0; k < state.answers.size(); ++k) {
            Json placed = Json::array();
            bool any = false;
            for (const int step : state.answers[k]) {
                placed.push_back(step > 0 ? Json(step) : Json(nullptr));
                any = any || step > 0;
            }
            if (any) json["ratings"][std::to_string(round.codes.at(k))] = placed;
        }
    }
    if (state.ballot) {
        const Ballot& ballot = state.ballot->ballot;
        json["ballot"] = {{"round", round.id},
                          {"best", code(ballot.best)},
                          {"second", code(ballot.second)},
                          {"least", code(ballot.least)}};
        json["receipt"] = state.ballot->receipt;
    }
    return dumped(json);
}

std::string problem_text(const std::string& problem) { return dumped({{"problem", problem}}); }

}  // namespace livery
