#include "desktop/studio_program.h"

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/paths.h"

namespace livery {
namespace {

using nlohmann::json;

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// In the settings that the program will read.
void keep_refining(const StudioStart& start) {
    const auto home = start.environment.find("LIVERY_HOME");
    const std::filesystem::path file =
        (home == start.environment.end() ? user_folder() : std::filesystem::path(home->second)) /
        "desktop.json";
    json kept = {{"format_version", 1}, {"settings", json::object()}};
    if (std::filesystem::exists(file)) kept = json::parse(text_of(file));
    kept["settings"]["refine-while-still"] = start.refines ? "yes" : "no";
    make_output_folder(file.parent_path());
    write_text_file(file, kept.dump());
}

}  // namespace

StudioProgram::StudioProgram(Desktop& desktop, const StudioStart& start) : desktop_(desktop) {
    keep_refining(start);
    ChildOptions options;
    options.arguments = {LIVERY_PROGRAM,
                         "desktop",
                         "--session",
                         start.session.string(),
                         "--ui-map",
                         (folder_ / "map").string(),
                         "--trace",
                         (folder_ / "trace").string(),
                         "--size",
                         fmt::format("{}x{}", start.size_px.x, start.size_px.y)};
    if (start.ui_scale) {
        options.arguments.insert(options.arguments.end(),
                                 {"--ui-scale", fmt::format("{}", *start.ui_scale)});
    }
    options.arguments.insert(
        options.arguments.end(), start.more_arguments.begin(), start.more_arguments.end());
    options.environment = start.environment;
    options.output = folder_ / "output";
    process_ = std::make_unique<ChildProcess>(options);
    const bool up = wait_until(
        [&] { return std::filesystem::exists(folder_ / "map") || !process_->running(); });
    if (!up || !process_->running()) {
        throw std::runtime_error("the desktop program showed no window:\n" + words());
    }
}

StudioProgram::~StudioProgram() = default;

int StudioProgram::quit() {
    desktop_.press_key("ctrl+q");
    const auto code = process_->wait(patience);
    if (!code) throw std::runtime_error("the desktop program did not quit:\n" + words());
    return *code;
}

json StudioProgram::map() const { return json::parse(text_of(folder_ / "map")); }

void StudioProgram::scroll_to_paint(const std::string& name) {
    // At the list's very edge the pointer is on no swatch, which would be tried on.
    const Rectangle list = item("swatches");
    const glm::ivec2 edge{list.x + list.width - 2, list.y + list.height / 2};
    constexpr int kNotches = 4, kMostTurns = 40;
    for (const int direction : {-1, 1}) {
        std::vector<std::string> seen;
        for (int turn = 0; turn < kMostTurns && !has_item(name); ++turn) {
            auto now = items_starting_with("paint:");
            if (std::exchange(seen, now) == now) break;
            scroll(edge, direction * kNotches);
        }
    }
}

Rectangle StudioProgram::steady_item(const std::string& name) const {
    const auto look = [&]() -> Rectangle {
        const json map = this->map();
        const auto& items = map["items"];
        // What was done may still move it, although the projector shows it already.
        if (!map["state"]["at_rest"].get<bool>() || !items.contains(name)) return {};
        const auto at = items[name].get<std::vector<int>>();
        const auto window = map["window"].get<std::vector<int>>();
        return {window[0] + at[0], window[1] + at[1], at[2], at[3]};
    };
    const Rectangle before = look();
    sleep_ms(30);
    const Rectangle now = look();
    return now == before ? now : Rectangle{};
}

Rectangle StudioProgram::item(const std::string& name) {
    if (name.starts_with("paint:") && has_item("swatches") && !has_item(name)) {
        scroll_to_paint(name);
    }
    Rectangle found;
    const auto steady = [&] {
        found = steady_item(name);
        return found.width > 0;
    };
    if (!wait_until(steady)) {
        throw std::runtime_error(fmt::format("no \"{}\" in the window, only: {}\n{}",
                                             name,
                                             fmt::join(items_starting_with(""), ", "),
                                             words()));
    }
    return found;
}

std::map<std::string, Rectangle> StudioProgram::items() {
    const json map = this->map();
    const auto window = map["window"].get<std::vector<int>>();
    std::map<std::string, Rectangle> found;
    for (const auto& [name, place] : map["items"].items()) {
        const auto at = place.get<std::vector<int>>();
        found[name] = {window[0] + at[0], window[1] + at[1], at[2], at[3]};
    }
    return found;
}

bool StudioProgram::has_item(const std::string& name) { return map()["items"].contains(name); }

std::vector<std::string> StudioProgram::items_starting_with(const std::string& prefix) {
    std::vector<std::string> names;
    const json map = this->map();
    for (const auto& [name, place] : map["items"].items()) {
        if (name.starts_with(prefix)) names.push_back(name);
    }
    return names;
}

json StudioProgram::state(const std::string& name) {
    const json map = this->map();
    return map.contains("state") && map["state"].contains(name) ? map["state"][name] : json();
}

std::string StudioProgram::words() const {
    std::string said = tail_of(folder_ / "output", 40);
    if (const auto file = folder_ / "map"; std::filesystem::exists(file)) {
        const json map = json::parse(text_of(file));
        if (map.contains("state")) said += map["state"].dump();
    }
    return said;
}

void StudioProgram::wait_for_state(const std::string& name, const json& value) {
    if (wait_until([&] { return state(name) == value; })) return;
    throw std::runtime_error(
        fmt::format("{} is {} instead of {}\n{}", name, state(name).dump(), value.dump(), words()));
}

glm::ivec2 StudioProgram::point_at(const std::string& name) {
    glm::ivec2 at = middle(item(name));
    for (;;) {
        desktop_.move_pointer(at.x, at.y);
        // What opens where it is pointed at has no place of its own any more.
        Rectangle now;
        const auto known = [&] {
            now = steady_item(name);
            const json map = this->map();
            return now.width > 0 ||
                   (map["state"]["at_rest"].get<bool>() && !map["items"].contains(name));
        };
        if (!wait_until(known) || now.width <= 0 || middle(now) == at) return at;
        at = middle(now);
    }
}

void StudioProgram::hover(const std::string& name) {
    const glm::ivec2 at = middle(item(name));
    // From one pixel away, so that there is a motion even when the pointer was there already.
    desktop_.move_pointer(at.x - 1, at.y);
    desktop_.move_pointer(at.x, at.y);
}

void StudioProgram::click(const std::string& name) {
    const glm::ivec2 at = point_at(name);
    const int before = state("clicks");
    desktop_.click(at.x, at.y);
    wait_until_taken("clicks", before + 1);
}

void StudioProgram::double_click(const std::string& name) {
    const glm::ivec2 at = point_at(name);
    const int before = state("clicks");
    desktop_.double_click(at.x, at.y);
    wait_until_taken("clicks", before + 2);
}

void StudioProgram::drag(glm::ivec2 from, glm::ivec2 to) {
    const int before = state("clicks");
    desktop_.drag(from, to);
    wait_until_taken("clicks", before + 1);
}

void StudioProgram::press_key(const std::string& keys) {
    const int before = state("keys");
    desktop_.press_key(keys);
    wait_until_taken("keys", before + 1);
}

void StudioProgram::scroll(glm::ivec2 at, int notches) {
    const int before = state("notches");
    desktop_.move_pointer(at.x, at.y);
    desktop_.scroll(notches);
    wait_until_taken("notches", before + std::abs(notches));
}

void StudioProgram::wait_until_taken(const std::string& counter, int value) {
    int frame = 0;
    const auto taken = [&] {
        frame = state("frame");
        return state(counter) >= value;
    };
    // At rest, every frame that it meant has been drawn: seen late, they are not followed by more.
    const auto shown = [&] { return state("frame") >= frame + 2 || state("at_rest") == true; };
    // A click may end the program.
    const auto ended = [&] { return !process_->running(); };
    const bool done = wait_until([&] { return taken() || ended(); }) &&
                      wait_until([&] { return shown() || ended(); });
    if (!done) {
        throw std::runtime_error(
            fmt::format("the window does not take input: {} {} of {}, frame {} of {}\n{}",
                        counter,
                        state(counter).dump(),
                        value,
                        state("frame").dump(),
                        frame + 2,
                        words()));
    }
}

void StudioProgram::move_away() {
    // The last row of the window belongs to the status line.
    const auto window = map()["window"].get<std::vector<int>>();
    desktop_.move_pointer(window[0] + window[2] / 2, window[1] + window[3] - 2);
}

std::vector<TraceLine> StudioProgram::trace() const {
    std::vector<TraceLine> lines;
    std::ifstream stream(folder_ / "trace");
    for (std::string text; std::getline(stream, text);) {
        const json line = json::parse(text, nullptr, false);
        if (line.is_discarded()) break;  // being written, or cut off by a kill
        lines.push_back({line["t_s"], line["event"], line["number"], line.value("what", "")});
    }
    return lines;
}

glm::ivec2 middle(const Rectangle& area) {
    return {area.x + area.width / 2, area.y + area.height / 2};
}

}  // namespace livery
