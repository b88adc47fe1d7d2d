// Drives the desktop program as a person does: by what stands in its window, with mouse and keys.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>

#include "support/child_process.h"
#include "support/desktop.h"
#include "support/temporary_folder.h"

namespace livery {

/// A line of the program's `--trace`.
struct TraceLine {
    double t_s = 0.0;
    std::string event;
    std::uint64_t number = 0;
    std::string what;
};

struct StudioStart {
    std::filesystem::path session;
    glm::ivec2 size_px{1280, 800};
    std::optional<double> ui_scale = 1.0;  ///< none: the screen's and the user's
    std::vector<std::string> more_arguments = {};
    std::map<std::string, std::string> environment = {};  ///< on top of the test's own
    /// The mock-up's picture gets finer by itself; else it stays as the document has its levels.
    bool refines = false;
};

/// Everything that waits throws std::runtime_error after its timeout, with what there was instead.
class StudioProgram {
  public:
    /// Starts it and waits for its window.
    StudioProgram(Desktop& desktop, const StudioStart& start);
    ~StudioProgram();

    ChildProcess& process() { return *process_; }
    /// Asks it to quit as a person does; its exit code.
    int quit();

    /// The place on the desktop of an item, once it is there and has stopped moving. A paint is
    /// looked for as a person does, by scrolling through the swatches.
    Rectangle item(const std::string& name);
    bool has_item(const std::string& name);
    /// Every item where it is now.
    std::map<std::string, Rectangle> items();
    std::vector<std::string> items_starting_with(const std::string& prefix);
    /// What the window says about itself; null for what it does not say.
    nlohmann::json state(const std::string& name);
    void wait_for_state(const std::string& name, const nlohmann::json& value);

    void hover(const std::string& name);
    /// A click, a drag, a key and a notch are done when the window has drawn what came of them.
    void click(const std::string& name);
    void double_click(const std::string& name);
    void drag(glm::ivec2 from, glm::ivec2 to);
    void press_key(const std::string& keys);
    /// Turns the wheel with the pointer at a place of the desktop.
    void scroll(glm::ivec2 at, int notches);
    /// The pointer to where nothing reacts to it.
    void move_away();

    std::vector<TraceLine> trace() const;
    /// What the program and its driver said and the window's state, for a failure's message.
    std::string words() const;

  private:
    nlohmann::json map() const;
    void scroll_to_paint(const std::string& name);
    /// Of a window at rest, which two looks agree on; empty where there is none.
    Rectangle steady_item(const std::string& name) const;
    /// Moves the pointer to an item's middle, and after it until it stays there: a picture that
    /// comes in may move what is about to be clicked.
    glm::ivec2 point_at(const std::string& name);
    /// Until the window shows what came of input: its counter has reached `value`, and two more
    /// frames put everything in its place. Not that anything came of it.
    void wait_until_taken(const std::string& counter, int value);

    Desktop& desktop_;
    TemporaryFolder folder_;
    std::unique_ptr<ChildProcess> process_;
};

/// Middle of a rectangle.
glm::ivec2 middle(const Rectangle& area);

}  // namespace livery
