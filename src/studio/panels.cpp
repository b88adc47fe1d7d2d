// The list of all panels.
#include <stdexcept>

#include "studio/studio.h"

namespace livery {

// Each is in the panel's own file. Whoever adds one names it here, and in its place in the list.
Panel editing_panel(), sessions_panel(), looks_panel(), parts_panel(), presenting_panel(),
    capture_panel(), nudge_panel(), seats_panel(), ballot_panel(), projector_panel(), stage_panel(),
    tabs_panel(), library_panel(), paint_panel(), artwork_panel(), lighting_panel(),
    calibration_panel(), plan_panel(), accuracy_panel(), keys_panel(), report_panel(),
    program_panel(), new_session_panel();

const std::vector<Panel>& all_panels() {
    static const std::vector<Panel> panels = {
        editing_panel(),     sessions_panel(),  looks_panel(),      parts_panel(),
        presenting_panel(),  capture_panel(),   nudge_panel(),      seats_panel(),
        ballot_panel(),      projector_panel(), stage_panel(),      tabs_panel(),
        library_panel(),     paint_panel(),     artwork_panel(),    lighting_panel(),
        calibration_panel(), plan_panel(),      accuracy_panel(),   keys_panel(),
        report_panel(),      program_panel(),   new_session_panel()};
    return panels;
}

const Panel& panel_named(std::string_view name) {
    for (const Panel& panel : all_panels()) {
        if (panel.name == name) return panel;
    }
    throw std::invalid_argument("no panel is called \"" + std::string(name) + "\"");
}

bool is_open(const Studio& studio, std::string_view name) {
    return panel_named(name).is_open(studio);
}

void show_panel(Studio& studio, std::string_view name, bool shown) {
    panel_named(name).show(studio, shown);
}

std::size_t letters_taken(const Studio& studio) {
    for (const Panel& panel : all_panels()) {
        if (const std::size_t letters = panel.letters ? panel.letters(studio) : 0) return letters;
    }
    return 0;
}

Action panel_action(const char* id, const char* panel, const char* menu, const char* label) {
    Action action{id, menu, label};
    action.run = [panel](Studio& s) { show_panel(s, panel, !is_open(s, panel)); };
    action.checked = [panel](const Studio& s) { return is_open(s, panel); };
    return action;
}

}  // namespace livery
