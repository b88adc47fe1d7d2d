#include "evaluation/presenting/presentation.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/json.h"

namespace livery {

namespace {

using Phase = PresentationPhase;
using Event = PresentationEvent;

const std::vector<int>& sitting_of(const PresentationPlan& plan, const PresentationState& state) {
    return plan.sittings.at(static_cast<std::size_t>(state.sitting));
}

int last_place(const PresentationPlan& plan, const PresentationState& state) {
    return static_cast<int>(sitting_of(plan, state).size()) - 1;
}

/// Nothing comes after it by itself: people remember, and the operator lets them vote.
bool is_over(const PresentationPlan& plan, const PresentationState& state) {
    return state.phase == Phase::presenting && state.grey && state.place == last_place(plan, state);
}

bool has_next_sitting(const PresentationPlan& plan, const PresentationState& state) {
    return state.sitting + 1 < static_cast<int>(plan.sittings.size());
}

/// The beginning of a step. Who pauses stays paused; a blank ends.
PresentationState begun(const PresentationPlan& plan, PresentationState state, double now_s) {
    state.blank = false;
    state.left_s = step_s(plan, state);
    state.at_s = now_s;
    return state;
}

PresentationState forward(const PresentationPlan& plan, PresentationState state) {
    if (state.phase == Phase::adapting) {
        state.phase = Phase::presenting;
        state.place = 0;
        state.grey = false;
    } else if (state.phase == Phase::voting) {
        state.phase = Phase::adapting;
        ++state.sitting;
        state.place = 0;
        state.grey = false;
    } else if (is_over(plan, state)) {
        state.phase = Phase::voting;
        state.place = 0;
        state.grey = state.paused = false;
    } else if (state.grey) {
        ++state.place;
        state.grey = false;
    } else {
        state.grey = true;
    }
    return state;
}

PresentationState backward(const PresentationPlan& plan, PresentationState state) {
    if (state.phase == Phase::voting) {
        state.phase = Phase::presenting;
        state.place = last_place(plan, state);
        state.grey = true;
        return state;
    }
    if (state.phase == Phase::presenting && !state.grey) {
        if (state.place > 0) {
            --state.place;
        } else {
            state.phase = Phase::adapting;
        }
    }
    state.grey = false;
    return state;
}

constexpr int kMostSteps = 1 << 20;

template <typename Value, typename Name>
Value value_named(const JsonReader& reader, int count, Name name) {
    const std::string text = reader.text();
    for (int k = 0; k < count; ++k) {
        if (text == name(static_cast<Value>(k))) return static_cast<Value>(k);
    }
    reader.fail('"' + text + '"', "a state or an event of a presentation");
}

std::vector<std::vector<int>> lists_in(const JsonReader& reader) {
    std::vector<std::vector<int>> lists;
    for (std::size_t s = 0; s < reader.size(); ++s) {
        const JsonReader list = reader.at(s);
        auto& numbers = lists.emplace_back();
        for (std::size_t k = 0; k < list.size(); ++k) {
            numbers.push_back(list.at(k).integer(0, kMostSteps));
        }
    }
    return lists;
}

}  // namespace

void check_times(const PresentationTimes& times) {
    for (const auto& [name, value] : {std::pair{"adaptation", times.adapt_s},
                                      std::pair{"look", times.look_s},
                                      std::pair{"grey", times.grey_s}}) {
        check_argument(
            value >= 0.2 && value <= 3600.0,
            std::string(name) + ": found " + std::to_string(value) + " s, expected 0.2 to 3600");
    }
}

void check_plan(const PresentationPlan& plan, int designs) {
    check_times(plan.times);
    check_argument(!plan.sittings.empty(), "a presentation: found no sittings, expected one");
    std::set<int> shown;
    for (const auto& sitting : plan.sittings) {
        check_argument(!sitting.empty(), "a presentation: found a sitting without looks");
        for (const int design : sitting) {
            check_argument(design >= 0 && design < designs,
                           "a presentation: found design " + std::to_string(design) +
                               ", expected 0 to " + std::to_string(designs - 1));
            shown.insert(design);
        }
    }
    check_argument(static_cast<int>(shown.size()) == designs,
                   "a presentation: found " + std::to_string(shown.size()) + " of " +
                       std::to_string(designs) + " designs in it, expected all");
    if (plan.seats.empty()) return;
    check_argument(plan.seats.size() == plan.sittings.size(),
                   "a presentation: found seats of " + std::to_string(plan.seats.size()) +
                       " sittings, expected " + std::to_string(plan.sittings.size()));
    std::set<int> seated;
    for (const auto& wave : plan.seats) {
        for (const int seat : wave) {
            check_argument(seat > 0 && seated.insert(seat).second,
                           "a presentation: found seat " + std::to_string(seat) +
                               ", expected numbers from 1, none twice");
        }
    }
}

std::string frame_of_look(int design) { return "look-" + std::to_string(design); }

std::string frame_of_grey(int one, int other) {
    return "grey-" + std::to_string(std::min(one, other)) + "-" +
           std::to_string(std::max(one, other));
}

std::vector<std::string> frames_needed(const std::vector<std::vector<int>>& sittings) {
    std::set<std::string> names = {kWhiteFrame, kRestFrame};
    for (const auto& sitting : sittings) {
        for (std::size_t k = 0; k < sitting.size(); ++k) {
            names.insert(frame_of_look(sitting[k]));
            if (k > 0) names.insert(frame_of_grey(sitting[k - 1], sitting[k]));
        }
    }
    return {names.begin(), names.end()};
}

bool is_allowed(const PresentationPlan& plan,
                const PresentationState& state,
                PresentationEvent event) {
    const bool shows = state.phase == Phase::adapting || state.phase == Phase::presenting;
    switch (event) {
        case Event::tick:
        case Event::resume:
            return true;
        case Event::present:
            return state.phase == Phase::edit;
        case Event::pause:
        case Event::blank:
            return shows;
        case Event::repeat:
        case Event::abort:
            return shows;
        case Event::back:
            return shows || state.phase == Phase::voting;
        case Event::next:
            return shows || (state.phase == Phase::voting && has_next_sitting(plan, state));
        case Event::lock:
            return state.phase == Phase::voting;
        case Event::done:
            return state.phase == Phase::locked;
    }
    return false;
}

PresentationState after(const PresentationPlan& plan,
                        PresentationState state,
                        PresentationEvent event,
                        double now_s) {
    if (!is_allowed(plan, state, event)) return state;
    switch (event) {
        case Event::tick:
            if (!is_running(state)) return state;
            if (left_s(state, now_s) > 0.0) return state;
            return begun(plan, forward(plan, state), now_s);
        case Event::present:
            state = {};
            state.phase = Phase::adapting;
            return begun(plan, state, now_s);
        case Event::pause:
        case Event::blank:
            state.left_s = left_s(state, now_s);
            state.at_s = now_s;
            if (event == Event::pause) state.paused = !state.paused;
            if (event == Event::blank) state.blank = !state.blank;
            return state;
        case Event::repeat:
            state.grey = false;
            return begun(plan, state, now_s);
        case Event::next:
            return begun(plan, forward(plan, state), now_s);
        case Event::back:
            return begun(plan, backward(plan, state), now_s);
        case Event::lock:
            state.phase = Phase::locked;
            return begun(plan, state, now_s);
        case Event::abort:
        case Event::done: {
            PresentationState edit;
            edit.at_s = now_s;
            return edit;
        }
        case Event::resume:
            state.paused = state.phase == Phase::adapting || state.phase == Phase::presenting;
            return begun(plan, state, now_s);
    }
    return state;
}

double left_s(const PresentationState& state, double now_s) {
    if (!is_running(state)) return state.left_s;
    return std::max(0.0, state.left_s - std::max(0.0, now_s - state.at_s));
}

double step_s(const PresentationPlan& plan, const PresentationState& state) {
    switch (state.phase) {
        case Phase::adapting:
            return plan.times.adapt_s;
        case Phase::presenting:
            if (is_over(plan, state)) return kWaits;
            return state.grey ? plan.times.grey_s : plan.times.look_s;
        case Phase::voting:
            return kWaits;
        case Phase::edit:
        case Phase::locked:
            break;
    }
    return 0.0;
}

bool is_running(const PresentationState& state) {
    const bool shows = state.phase == Phase::adapting || state.phase == Phase::presenting;
    return shows && !state.paused && !state.blank && state.left_s < kWaits;
}

int design_of(const PresentationPlan& plan, const PresentationState& state) {
    if (state.phase != Phase::presenting || state.grey || state.blank) return -1;
    return sitting_of(plan, state).at(static_cast<std::size_t>(state.place));
}

std::string frame_of(const PresentationPlan& plan, const PresentationState& state) {
    if (state.phase == Phase::edit) return "";
    const bool votes = state.phase == Phase::voting || state.phase == Phase::locked;
    if (votes || state.blank) return kRestFrame;
    if (state.phase == Phase::adapting) return kWhiteFrame;
    if (const int design = design_of(plan, state); design >= 0) return frame_of_look(design);
    if (is_over(plan, state)) return kRestFrame;
    const auto& sitting = sitting_of(plan, state);
    const auto place = static_cast<std::size_t>(state.place);
    return frame_of_grey(sitting[place], sitting[place + 1]);
}

double duration_s(const PresentationPlan& plan) {
    double total = 0.0;
    for (const auto& sitting : plan.sittings) {
        const auto looks = static_cast<double>(sitting.size());
        total += plan.times.adapt_s + looks * plan.times.look_s + (looks - 1.0) * plan.times.grey_s;
    }
    return total;
}

const char* to_string(PresentationPhase phase) {
    static constexpr std::array<const char*, 5> names = {
        "edit", "adapting", "presenting", "voting", "locked"};
    return names.at(static_cast<std::size_t>(phase));
}

const char* to_string(PresentationEvent event) {
    static constexpr std::array<const char*, kPresentationEvents> names = {"tick",
                                                                           "present",
                                                                           "pause",
                                                                           "blank",
                                                                           "repeat",
                                                                           "next",
                                                                           "back",
                                                                           "lock",
                                                                           "abort",
                                                                           "done",
                                                                           "resume"};
    return names.at(static_cast<std::size_t>(event));
}

// --- as JSON ---

std::string text_of(const PresentationPlan& plan) {
    Json json = {{"sittings", plan.sittings},
                 {"adapt_s", plan.times.adapt_s},
                 {"look_s", plan.times.look_s},
                 {"grey_s", plan.times.grey_s},
                 {"session", plan.session},
                 {"folder", plan.folder},
                 {"frames", plan.frames}};
    if (!plan.seats.empty()) json["seats"] = plan.seats;
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

PresentationPlan parse_plan(const std::string& text, const std::string& file) {
    const Json json = parse_json(text, file);
    const JsonReader reader(file, json);
    PresentationPlan plan;
    plan.sittings = lists_in(reader["sittings"]);
    if (reader.has("seats")) plan.seats = lists_in(reader["seats"]);
    plan.times = {reader["adapt_s"].number(), reader["look_s"].number(), reader["grey_s"].number()};
    plan.session = reader["session"].text();
    plan.folder = reader["folder"].text();
    const JsonReader frames = reader["frames"];
    for (const std::string& name : frames.keys()) plan.frames[name] = frames[name].text();
    return plan;
}

std::string text_of(const PresentationState& state, PresentationEvent event) {
    const Json json = {{"event", to_string(event)},
                       {"phase", to_string(state.phase)},
                       {"sitting", state.sitting},
                       {"place", state.place},
                       {"grey", state.grey},
                       {"paused", state.paused},
                       {"blank", state.blank}};
    return json.dump();
}

PresentationStep parse_step(const std::string& text, const std::string& file) {
    const Json json = parse_json(text, file);
    const JsonReader reader(file, json);
    PresentationStep step;
    step.event =
        value_named<PresentationEvent>(reader["event"], kPresentationEvents, [](auto value) {
            return std::string(to_string(value));
        });
    step.state.phase = value_named<PresentationPhase>(
        reader["phase"], 5, [](auto value) { return std::string(to_string(value)); });
    step.state.sitting = reader["sitting"].integer(0, kMostSteps);
    step.state.place = reader["place"].integer(0, kMostSteps);
    step.state.grey = reader["grey"].boolean();
    step.state.paused = reader["paused"].boolean();
    step.state.blank = reader["blank"].boolean();
    return step;
}

}  // namespace livery
