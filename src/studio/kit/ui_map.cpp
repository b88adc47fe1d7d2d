#include "studio/kit/ui_map.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "core/error.h"
#include "core/json.h"
#include "studio/kit/imgui_versions.h"

namespace livery {

namespace {

// Panels name items deep inside their drawing; Dear ImGui's state is just as global.
bool naming = false;
ItemPlaces mapped;

ItemPlace place_of(float left, float top, float right, float bottom) {
    const int x = static_cast<int>(std::floor(left)), y = static_cast<int>(std::floor(top));
    return {x, y, static_cast<int>(std::ceil(right)) - x, static_cast<int>(std::ceil(bottom)) - y};
}

Json json_of(const ItemPlace& place) {
    return Json::array({place.x, place.y, place.width, place.height});
}

}  // namespace

void start_naming_items(bool wanted) {
    naming = wanted;
    mapped.clear();
    start_tab_order();
}

ItemPlaces take_named_items() { return std::exchange(mapped, {}); }

void name_rectangle(const std::string& name, float x, float y, float width, float height) {
    if (naming) mapped[name] = place_of(x, y, x + width, y + height);
}

void name_last_item(const std::string& name) {
    note_tab_stop(name);
    if (!naming) return;
    // A pop-up's first frames only measure it: it is not seen, and not yet at its place.
    if (ImGui::GetCurrentWindowRead()->Hidden) return;
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 clip_low = list.GetClipRectMin(), clip_high = list.GetClipRectMax();
    const float left = std::max(low.x, clip_low.x), top = std::max(low.y, clip_low.y);
    const float right = std::min(high.x, clip_high.x), bottom = std::min(high.y, clip_high.y);
    if (right - left >= 1.0f && bottom - top >= 1.0f)
        mapped[name] = place_of(left, top, right, bottom);
}

std::string map_text(bool value) { return value ? "true" : "false"; }
std::string map_text(const std::string& value) { return Json(value).dump(); }
std::string map_text(const char* value) { return map_text(std::string(value)); }
std::string map_text(const std::optional<int>& value) {
    return value ? std::to_string(*value) : "null";
}

std::string map_text(const MapState& object) {
    Json json = Json::object();
    for (const auto& [name, value] : object) json[name] = Json::parse(value);
    return json.dump();
}

std::string ui_map_text(const ItemPlaces& items,
                        const MapState& state,
                        const ItemPlace& window_on_desktop) {
    Json json = {{"format_version", 1}, {"window", json_of(window_on_desktop)}};
    for (const auto& [name, value] : state) json["state"][name] = Json::parse(value);
    json["items"] = Json::object();
    for (const auto& [name, place] : items) json["items"][name] = json_of(place);
    return json.dump(1) + "\n";
}

void UiMapFile::update(const ItemPlaces& items,
                       const MapState& state,
                       const ItemPlace& window_on_desktop) {
    const std::string text = ui_map_text(items, state, window_on_desktop);
    if (text == written_) return;
    // Not flushed to the disk as a user's file is: it says what is now, and nothing later.
    auto temporary = file_;
    temporary += ".part";
    std::ofstream(temporary, std::ios::binary) << text;
    std::error_code error;
    std::filesystem::rename(temporary, file_, error);
    if (error) throw FileError(file_, "", error.message(), "a file that can be written");
    written_ = text;
}

namespace {

struct Stop {
    ImGuiID id = 0;
    std::string name;
    ::ImGuiWindow* window = nullptr;
    ImGuiNavLayer layer = ImGuiNavLayer_Main;
    ImGuiID focus_scope = 0;
    ImRect rectangle;  ///< of the window's content
    bool is_field = false;
};

// Panels name items deep inside their drawing; Dear ImGui's state is just as global.
std::vector<Stop> stops;
std::optional<std::size_t> group_start;

/// The window that has the keyboard to itself: the topmost dialog or list, or none.
const ::ImGuiWindow* keyboard_window() {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    for (int i = g.OpenPopupStack.Size - 1; i >= 0; --i) {
        const ::ImGuiWindow* window = g.OpenPopupStack[i].Window;
        if (window && !(window->Flags & ImGuiWindowFlags_Tooltip)) return window;
    }
    return nullptr;
}

bool is_inside(const ::ImGuiWindow* window, const ::ImGuiWindow* outer) {
    for (; window; window = window->ParentWindow) {
        if (window == outer) return true;
        if (!(window->Flags & ImGuiWindowFlags_ChildWindow)) return false;
    }
    return false;
}

/// Gives the keyboard to an item; a field is typed in from the next frame on.
void focus(const Stop& stop) {
    ImGuiContext& g = *ImGui::GetCurrentContext();
    if (g.ActiveId != 0) ImGui::ClearActiveID();
    ImGui::FocusWindow(stop.window);
    ImGui::SetNavID(stop.id, stop.layer, stop.focus_scope, stop.rectangle);
    g.NavDisableHighlight = false;
    g.NavDisableMouseHover = true;
    g.NavInputSource = ImGuiInputSource_Keyboard;
    ImRect on_screen = stop.rectangle;
    on_screen.Translate(stop.window->Pos);
    ImGui::ScrollToBringRectIntoView(stop.window, on_screen);
    if (stop.is_field) {
        g.NavNextActivateId = stop.id;
        g.NavNextActivateFlags = ImGuiActivateFlags_PreferInput;
    }
}

/// For an item that is being drawn in the current window.
Stop stop_here(ImGuiID id, ImRect on_screen) {
    Stop stop;
    stop.id = id;
    stop.window = ImGui::GetCurrentWindow();
    stop.layer = stop.window->DC.NavLayerCurrent;
    stop.focus_scope = current_focus_scope();
    stop.rectangle = on_screen;
    stop.rectangle.Translate({-stop.window->Pos.x, -stop.window->Pos.y});
    return stop;
}

}  // namespace

void start_tab_order() {
    stops.clear();
    group_start.reset();
    // A field that is left would take up its undo steps again when it is typed in the next time,
    // and end the program where its text is another one by then.
    ImGuiContext& g = *ImGui::GetCurrentContext();
    if (g.ActiveId != g.InputTextState.ID) g.InputTextState.ID = 0;
}

void note_tab_stop(const std::string& name) {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    const ImGuiLastItemData& item = g.LastItemData;
    ::ImGuiWindow* window = g.CurrentWindow;
    const ImGuiItemFlags inert =
        ImGuiItemFlags_Disabled | ImGuiItemFlags_NoNav | ImGuiItemFlags_NoTabStop;
    if (item.ID == 0 || (item.InFlags & inert) != 0 || window->Hidden ||
        (window->Flags & ImGuiWindowFlags_NoNavFocus) != 0) {
        return;
    }
    // A group has the id of what is active in it.
    const bool known =
        std::any_of(stops.begin(), stops.end(), [&](const Stop& s) { return s.id == item.ID; });
    if (known) return;
    Stop stop = stop_here(item.ID, item.NavRect);
    stop.name = name;
    stop.is_field = (item.InFlags & ImGuiItemFlags_Inputable) != 0;
    stops.push_back(std::move(stop));
}

void begin_tab_group() { group_start = stops.size(); }

void end_tab_group(std::optional<unsigned> preferred) {
    if (!group_start) return;
    const auto begin = stops.begin() + static_cast<std::ptrdiff_t>(*group_start);
    group_start.reset();
    if (begin == stops.end()) return;
    const auto found =
        std::find_if(begin, stops.end(), [&](const Stop& stop) { return stop.id == preferred; });
    if (found != stops.end()) std::swap(*begin, *found);
    stops.erase(begin + 1, stops.end());
}

void move_focus(int step) {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    const ::ImGuiWindow* only = keyboard_window();
    std::vector<Stop*> order;
    for (Stop& stop : stops) {
        // Without a dialog: the program's own window, which is where all begins.
        const ::ImGuiWindow* outer = only ? only : stops.front().window->RootWindow;
        if (is_inside(stop.window, outer)) order.push_back(&stop);
    }
    if (order.empty()) return;
    const ImGuiID at = g.ActiveId != 0 ? g.ActiveId : g.NavId;
    const auto now =
        std::find_if(order.begin(), order.end(), [&](const Stop* stop) { return stop->id == at; });
    const auto count = static_cast<std::ptrdiff_t>(order.size());
    std::ptrdiff_t next = step > 0 ? 0 : count - 1;
    if (now != order.end()) next = (now - order.begin() + step + count) % count;
    focus(*order[static_cast<std::size_t>(next)]);
}

void focus_next_field(const char* label) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    Stop stop =
        stop_here(ImGui::GetID(label),
                  {at.x, at.y, at.x + ImGui::CalcItemWidth(), at.y + ImGui::GetFrameHeight()});
    stop.is_field = true;
    focus(stop);
}

std::string focused_item() {
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    const bool reads_its_own_keys =
        g.NavWindow && (g.NavWindow->Flags & ImGuiWindowFlags_NoNavInputs) != 0;
    if (g.NavDisableHighlight && g.ActiveId == 0 && !reads_its_own_keys) return "";
    const ImGuiID at = g.ActiveId != 0 ? g.ActiveId : g.NavId;
    const auto found =
        std::find_if(stops.begin(), stops.end(), [&](const Stop& stop) { return stop.id == at; });
    return found == stops.end() ? std::string() : found->name;
}

}  // namespace livery
