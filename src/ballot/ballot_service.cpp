#include "ballot/ballot_service.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

#include "ballot/ballot_guard.h"
#include "core/error.h"
#include "core/json.h"

namespace livery {

namespace {

constexpr double kCodeLife_s = 600.0;
constexpr double kTyping_s = 60.0;  ///< a code that has just changed is still good for so long
constexpr int kMostSeatsOfAll = 400;
constexpr std::string_view kJoinPath = "/join/";

BallotResponse problem(int status, const std::string& text) {
    BallotResponse response;
    response.status = status;
    response.body = problem_text(text);
    return response;
}

BallotResponse wrong_method(const char* allowed) {
    BallotResponse response =
        problem(405, std::string("found another method, expected ") + allowed);
    response.allow = allowed;
    return response;
}

BallotResponse too_many_changes() {
    return problem(429, "too many changes; this one is sent again in a moment");
}

BallotResponse page_file(const BallotRequest& request, const char* type, std::string_view text) {
    if (request.method != "GET" && request.method != "HEAD") return wrong_method("GET, HEAD");
    BallotResponse response;
    response.content_type = type;
    response.body = text;
    return response;
}

/// Why a request that changes something is refused before it is read; nothing when it is not.
std::optional<BallotResponse> refused(const BallotRequest& request, const ServerNames& names) {
    if (!origin_is_ours(request, names)) {
        return problem(403, "found a request of another page, expected one of this server's own");
    }
    if (request.content_type != "application/json") {
        return problem(415, "found another Content-Type, expected application/json");
    }
    return std::nullopt;
}

/// What a body says; std::invalid_argument for a bad one, which is no fault of a file of ours.
template <typename Parse>
auto in_body(const Parse& parse) {
    try {
        return parse();
    } catch (const FileError& error) {
        throw std::invalid_argument(error.what());
    }
}

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

// --- messages ---

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

// --- the server ---

BallotService::BallotService(const std::filesystem::path& file, BallotServiceSettings settings)
    : store_(file), settings_(std::move(settings)) {
    if (!store_.session()) store_.open_session();
}

void BallotService::keep_invitation(double now_s) {
    const auto session = store_.session();
    if (!session) return;
    auto invitation = store_.invitation(*session);
    if (invitation && static_cast<double>(invitation->code_until_s) > now_s) return;
    // The token stays: the QR code may hang on a wall.
    if (!invitation) {
        invitation = Invitation{random_secret(), "", 0};
    } else {
        last_ = *invitation;
    }
    invitation->code = random_join_code();
    invitation->code_until_s = static_cast<std::int64_t>(std::ceil(now_s + kCodeLife_s));
    store_.invite(*session, *invitation);
}

BallotResponse BallotService::answer(const BallotRequest& request, double now_s) {
    try {
        return route(request, now_s);
    } catch (const Refused& why) {
        return problem(409, std::string(why.what()));
    } catch (const std::invalid_argument& error) {
        return problem(400, error.what());
    } catch (const std::exception&) {
        // Which file, and what is wrong with it, is the operator's business.
        return problem(503, "this could not be kept; try again, or vote on paper");
    }
}

BallotResponse BallotService::route(const BallotRequest& request, double now_s) {
    if (!host_is_ours(request, settings_.names)) {
        return problem(421, "found another Host, expected the address that the operator shows");
    }
    if (request.path == "/") return page_file(request, "text/html; charset=utf-8", page_html());
    if (request.path == "/page.css") {
        return page_file(request, "text/css; charset=utf-8", page_css());
    }
    if (request.path == "/page.js") {
        return page_file(request, "text/javascript; charset=utf-8", page_js());
    }
    if (request.path == "/state") {
        if (request.method != "GET") return wrong_method("GET");
        BallotResponse response;
        response.body = text_of(state_for(request));
        return response;
    }
    if (request.path == "/join") {
        if (request.method != "POST") return wrong_method("POST");
        if (auto no = refused(request, settings_.names)) return std::move(*no);
        return join_by_code(request, now_s);
    }
    if (request.path.starts_with(kJoinPath)) {
        if (request.method != "GET") return wrong_method("GET");
        return join_by_token(request);
    }
    if (request.path == "/ballot") {
        if (request.method != "PUT") return wrong_method("PUT");
        if (auto no = refused(request, settings_.names)) return std::move(*no);
        return take_vote(request, now_s);
    }
    if (request.path == "/scales") {
        if (request.method != "PUT") return wrong_method("PUT");
        if (auto no = refused(request, settings_.names)) return std::move(*no);
        return take_rating(request, now_s);
    }
    return problem(404, "nothing is here");
}

// --- joining ---

BallotResponse BallotService::seated(const BallotRequest& request, BallotResponse response) {
    const int session = store_.session().value();
    if (seat_of(request, session) != 0) return response;
    const std::string secret = random_secret();
    auto& addresses = seated_[session];
    const int most = addresses.contains(request.client)
                         ? settings_.most_seats
                         : std::max(settings_.most_seats, kMostSeatsOfAll);
    store_.join(session, hash_of_secret(secret), most);
    addresses.insert(request.client);
    response.cookie = seat_cookie(secret, settings_.names.tls);
    return response;
}

BallotResponse BallotService::join_by_token(const BallotRequest& request) {
    // A browser that looks ahead must not take the seat of the person who then taps.
    if (request.purpose.find("prefetch") != std::string::npos) {
        return problem(403, "found a look ahead, expected a person");
    }
    const auto invitation = store_.invitation(store_.session().value());
    const std::string token = request.path.substr(kJoinPath.size());
    if (!invitation || !same_secret(token, invitation->token)) {
        return problem(403, "this code is not the one that is shown now; scan it again");
    }
    BallotResponse response;
    response.status = 303;
    response.location = "/";
    try {
        return seated(request, response);
    } catch (const Refused&) {
        // The page says why, in words for people.
        return response;
    }
}

bool BallotService::is_join_code(const std::string& code, int session, double now_s) {
    const auto invitation = store_.invitation(session);
    if (!invitation) return false;
    const auto fits = [&](const Invitation& shown, double longer_s) {
        return now_s < static_cast<double>(shown.code_until_s) + longer_s &&
               same_secret(code, shown.code);
    };
    return fits(*invitation, 0.0) || (last_.token == invitation->token && fits(last_, kTyping_s));
}

BallotResponse BallotService::join_by_code(const BallotRequest& request, double now_s) {
    const std::string code = tidy_join_code(in_body([&] { return parse_join(request.body); }));
    if (!is_join_code(code, store_.session().value(), now_s)) {
        return problem(403, "this code is not the one that is shown now");
    }
    BallotResponse response = seated(request, {});
    response.body = "{}";
    return response;
}

// --- voting ---

int BallotService::seat_of(const BallotRequest& request, int session) {
    const auto secret = seat_secret(request.cookies);
    if (!secret) return 0;
    return store_.seat_of_phone(session, hash_of_secret(*secret)).value_or(0);
}

PageState BallotService::state_for(const BallotRequest& request) {
    const int session = store_.session().value();
    PageState state;
    state.seat = seat_of(request, session);
    const auto round = store_.last_round(session);
    const bool open = round && !round->closed();
    if (state.seat == 0) {
        state.state = open ? "shut" : "join";
        return state;
    }
    if (!round) return state;
    state.round = round;
    const Turn turn = store_.turn_of(round->id, state.seat);
    if (open && turn.waves > 1) {
        state.wave = turn.wave + 1;
        state.waves = turn.waves;
    }
    state.votes = round->voting() && turn.votes;
    state.state = round->closed() ? "locked"
                  : state.votes   ? "voting"
                  : turn.sits     ? "presenting"
                                  : "waiting";
    if (!state.votes) return state;
    state.answers = store_.ratings_of(round->id, state.seat);
    state.ballot = store_.ballot_of(round->id, state.seat);
    return state;
}

/// What a seat sends, taken by `take`: its answer is what the page then shows.
template <typename Take>
BallotResponse BallotService::changed_by_seat(const BallotRequest& request,
                                              double now_s,
                                              const Take& take) {
    const int session = store_.session().value();
    const int seat = seat_of(request, session);
    if (seat == 0) return problem(401, "found no seat, expected to have joined");
    if (!changes_.allowed(seat, now_s)) return too_many_changes();
    take(seat, store_.last_round(session));
    changes_.changed(seat, now_s);
    BallotResponse response;
    response.body = text_of(state_for(request));
    return response;
}

BallotResponse BallotService::take_vote(const BallotRequest& request, double now_s) {
    return changed_by_seat(request, now_s, [&](int seat, const std::optional<Round>& round) {
        const Ballot ballot = in_body([&] { return parse_vote(request.body, round); });
        store_.vote(round->id, seat, ballot);
    });
}

BallotResponse BallotService::take_rating(const BallotRequest& request, double now_s) {
    return changed_by_seat(request, now_s, [&](int seat, const std::optional<Round>& round) {
        const auto rating = in_body([&] { return parse_rating(request.body, round); });
        store_.rate(round->id, seat, rating.design, rating.steps);
    });
}

}  // namespace livery
