// A desktop for tests: an X server of its own with an operator's monitor and a projector, pixels
// of both, a mouse and a keyboard.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <sys/types.h>

#include "core/image.h"
#include "support/child_process.h"

namespace livery {

struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Rectangle&) const = default;
};

struct Rgb {
    int r = 0, g = 0, b = 0;
    bool operator==(const Rgb&) const = default;
};
std::ostream& operator<<(std::ostream& stream, const Rgb& colour);
/// Largest difference of a channel.
int distance(const Rgb& a, const Rgb& b);

Rgb colour_at(const Image8& picture, int x, int y);
/// Mean over a rectangle of the picture.
Rgb mean_colour(const Image8& picture, const Rectangle& area);
/// Fraction of pixels that differ in a channel by more than `tolerance`; 1 for other sizes.
double fraction_different(const Image8& a, const Image8& b, int tolerance = 2);

struct DesktopOptions {
    glm::ivec2 operator_px{1280, 800};
    glm::ivec2 projector_px{1280, 800};  ///< to the right of the operator's
    bool window_manager = false;         ///< openbox
};

/// Starts Xorg's dummy driver on a free display and makes that DISPLAY of this process while it
/// lives; it must outlive every window of the test. Throws std::runtime_error with the server's
/// own words when it does not come up: a machine without it fails the test. One thread.
class Desktop {
  public:
    explicit Desktop(const DesktopOptions& options = {});
    ~Desktop();
    Desktop(const Desktop&) = delete;
    Desktop& operator=(const Desktop&) = delete;

    const std::string& display() const;  ///< ":5"
    pid_t server() const;                ///< the X server's process
    static constexpr const char* operator_output = "DUMMY0";
    static constexpr const char* projector_output = "DUMMY1";

    // Monitors. All return when the server has done it.
    void unplug_projector();
    enum class Side { left, right, above, below };
    void plug_projector(Side side = Side::right);  ///< also moves it there
    bool projector_plugged() const;
    Rectangle operator_area() const;
    Rectangle projector_area() const;  ///< throws std::logic_error while it is unplugged
    /// `xrandr` with these arguments; throws std::runtime_error with what it said.
    void xrandr(const std::vector<std::string>& arguments);

    // Pixels, as the monitors show them.
    Image8 read(const Rectangle& area) const;  ///< 3 channels
    Rgb pixel(int x, int y) const;

    // Mouse and keyboard.
    void move_pointer(int x, int y);
    void press_button(int button = 1);
    void release_button(int button = 1);
    void click(int x, int y, int button = 1);
    void double_click(int x, int y);
    void drag(glm::ivec2 from, glm::ivec2 to);
    void scroll(int notches);  ///< up is positive
    /// Names of X11 keysyms joined by plus: "ctrl+z", "Escape", "1", "shift+Tab".
    void press_key(const std::string& keys);  ///< for as long as a person does
    void hold_key(const std::string& keys);
    void release_key(const std::string& keys);
    void type(const std::string& text);  ///< letters, digits, space and what needs no AltGr

    /// Windows that show themselves and lie directly on the screen, lowest first.
    struct TopWindow {
        std::string title;
        Rectangle area;
        bool operator==(const TopWindow&) const = default;
    };
    std::vector<TopWindow> windows() const;
    /// As its button in the title bar does; only with a window manager.
    void minimise_active_window();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
