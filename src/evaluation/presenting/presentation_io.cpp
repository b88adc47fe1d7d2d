#include "core/json.h"
#include "evaluation/presenting/presentation.h"

namespace livery {

namespace {

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
